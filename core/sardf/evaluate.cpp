#include "sardf/evaluate.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "sardf/kernels.hpp"

namespace sardf {

namespace {

constexpr size_t block_size = Evaluator::block_size;
constexpr size_t widest_lanes = 16;

// Floats are evaluated in whole lanes.
template <class T>
size_t padded(size_t n) {
  return sizeof(T) == sizeof(double) ? n : (n + widest_lanes - 1) / widest_lanes * widest_lanes;
}

void run(const Instruction& i, const float* const* in, float* out, size_t n) {
  i.kernels->value(i.object, in, out, n);
}
void run(const Instruction& i, const double* const* in, double* out, size_t n) {
  i.operation->evaluate(in, out, n);
}
void run(const Instruction& i, const float* const* in, float* out, float* const* by, size_t n) {
  i.kernels->partials(i.object, in, out, by, n);
}
void run(const Instruction& i, const double* const* in, double* out, double* const* by, size_t n) {
  i.operation->partials(in, out, by, n);
}

size_t run_pairs(const Instruction* first, const float* const* in, float* const* at, size_t n) {
  const size_t pairs = first->pairs;
  const float* const before = at[first[1].in[0]];
  const Instruction& last = first[2 * pairs - 1];
  if (pairs == 1) {
    first->fused->value(first->object, last.object, in, before, at[last.out], n);
    return 2;
  }
  std::array<const void*, most_pairs> objects;
  for (size_t k = 0; k < pairs; ++k) objects[k] = first[2 * k].object;
  first->fused->several(objects.data(), pairs, last.object, in, before, at[last.out], n);
  return 2 * pairs;
}

// Evaluates an instruction, or those that one call evaluates from it on, and returns their number.
// Register r lies at at[r].
size_t run_from(const Instruction* first, const float* const* in, float* const* at, size_t n) {
  if (first->fused) return run_pairs(first, in, at, n);
  const size_t count = first->together;
  if (count == 1) {
    run(*first, in, at[first->out], n);
    return count;
  }
  std::array<const void*, most_together> objects;
  std::array<float*, most_together> out;
  for (size_t k = 0; k < count; ++k) {
    objects[k] = first[k].object;
    out[k] = at[first[k].out];
  }
  first->kernels->together->value(objects.data(), in, out.data(), n);
  return count;
}
size_t run_from(const Instruction* i, const double* const* in, double* const* at, size_t n) {
  run(*i, in, at[i->out], n);
  return 1;
}

// Copies the coordinates into registers 0, 1, 2, the last point repeated up to the padded length.
template <class T>
void load_coordinates(const T* const* xyz, size_t n, T* registers) {
  for (int axis = 0; axis < 3; ++axis) {
    T* to = registers + axis * block_size;
    std::copy_n(xyz[axis], n, to);
    std::fill(to + n, to + padded<T>(n), xyz[axis][n - 1]);
  }
}

// A thread's room for `size` values, with the constants of a tape in their registers up to n, which
// stay there until another tape's are asked for.
template <class T>
T* registers_of(const Tape& tape, size_t size, size_t n) {
  thread_local Scratch<T> storage;
  thread_local struct {
    uint64_t tape;
    T* at;
    size_t n;
  } known{};
  T* const registers = storage.get(size);
  if (known.tape == tape.number() && known.at == registers && known.n >= n) return registers;
  for (const Tape::Constant& c : tape.constants()) {
    std::fill_n(registers + c.reg * block_size, n, T(c.value));
  }
  known = {tape.number(), registers, n};
  return registers;
}

bool is_aligned(const void* memory) {
  return reinterpret_cast<uintptr_t>(memory) % cache_line == 0;
}

// Where each register lies, those that are not computed filled. Of a block of whole lanes the
// caller's arrays are the registers of the coordinates, which no instruction writes to, and of
// results that are outputs.
template <class T>
T* const* place_registers(const Tape& tape, const T* const* xyz, size_t n, T* const* out) {
  T* const registers = registers_of<T>(tape, tape.registers() * block_size, padded<T>(n));
  thread_local Scratch<T*> places;
  T** at = places.get(tape.registers());
  for (size_t r = 0; r < tape.registers(); ++r) at[r] = registers + r * block_size;
  const bool whole = n == padded<T>(n);
  if (whole && std::all_of(xyz, xyz + 3, is_aligned)) {
    for (size_t axis = 0; axis < 3; ++axis) at[axis] = const_cast<T*>(xyz[axis]);
  } else {
    load_coordinates(xyz, n, registers);
  }
  if (!whole) return at;
  const size_t first_result = 3 + tape.constants().size();
  for (size_t k = 0; k < tape.outputs().size(); ++k) {
    const uint32_t r = tape.outputs()[k];
    if (r >= first_result) at[r] = out[k];
  }
  return at;
}

template <class T>
void evaluate_block(const Tape& tape, const T* const* xyz, size_t n, T* const* out) {
  T* const* at = place_registers(tape, xyz, n, out);
  const Instruction* step = tape.instructions().data();
  const Instruction* const end = step + tape.instructions().size();
  while (step != end) {
    std::array<const T*, max_arity> in;
    for (size_t k = 0; k < in.size(); ++k) in[k] = at[step->in[k]];
    step += run_from(step, in.data(), at, padded<T>(n));
  }
  for (size_t k = 0; k < tape.outputs().size(); ++k) {
    const T* result = at[tape.outputs()[k]];
    if (result != out[k]) std::copy_n(result, n, out[k]);
  }
}

void chain(const float* by, const float* inner, float* outer, size_t n, bool add) {
  static const ChainKernel kernel = chain_kernel();
  kernel(by, inner, outer, n, add);
}
void chain(const double* by, const double* inner, double* outer, size_t n, bool add) {
  for (size_t i = 0; i < n; ++i) {
    // A branch that is not taken has the partial 0; its gradient may be NaN and must not count.
    const double term = !inner ? by[i] : by[i] == 0 ? 0 : by[i] * inner[i];
    outer[i] = add ? outer[i] + term : term;
  }
}

template <class T>
void gradient_of_block(const Tape& tape, const T* const* xyz, size_t n, T* out,
                       T* const* gradient) {
  const size_t m = padded<T>(n), registers_end = tape.registers() * block_size;
  T* registers = registers_of<T>(tape, 4 * registers_end + max_arity * block_size, m);
  T* by[max_arity];
  for (int k = 0; k < max_arity; ++k) by[k] = registers + 4 * registers_end + k * block_size;
  const auto slope = [&](uint32_t reg, int axis) {
    return registers + registers_end + (3 * size_t(reg) + axis) * block_size;
  };
  // Coordinates and constants come first; their slopes are 1 and 0 and are not stored.
  const uint32_t first_stored = uint32_t(3 + tape.constants().size());
  load_coordinates(xyz, n, registers);
  for (const Instruction& i : tape.instructions()) {
    std::array<const T*, max_arity> in;
    for (size_t k = 0; k < in.size(); ++k) in[k] = registers + i.in[k] * block_size;
    run(i, in.data(), registers + i.out * block_size, by, m);
    const int arity = i.operation->info().arity;
    for (int axis = 0; axis < 3; ++axis) {
      T* to = slope(i.out, axis);
      bool add = false;
      for (int k = 0; k < arity; ++k) {
        const bool is_stored = i.in[k] >= first_stored;
        if (!is_stored && int(i.in[k]) != axis) continue;
        chain(by[k], is_stored ? slope(i.in[k], axis) : nullptr, to, m, add);
        add = true;
      }
      if (!add) std::fill_n(to, m, T(0));
    }
  }
  const uint32_t result = tape.outputs()[0];
  if (out) std::copy_n(registers + result * block_size, n, out);
  for (int axis = 0; axis < 3; ++axis) {
    if (result >= first_stored) {
      std::copy_n(slope(result, axis), n, gradient[axis]);
    } else {
      std::fill_n(gradient[axis], n, T(int(result) == axis));
    }
  }
}

// Splits n points into blocks over all threads; work(first, count) for each.
template <class Work>
void for_blocks(size_t n, const Progress& progress, Work work) {
  const size_t blocks = (n + block_size - 1) / block_size;
  std::atomic<bool> cancelled{false};
  std::atomic<size_t> done{0};
  std::mutex reporting;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, blocks, 16), [&](const auto& range) {
    for (size_t b = range.begin(); b < range.end() && !cancelled; ++b) {
      work(b * block_size, std::min(block_size, n - b * block_size));
    }
    done += range.size();
    if (!progress) return;
    const std::scoped_lock lock(reporting);
    if (!cancelled && !progress(double(done) / double(blocks))) cancelled = true;
  });
  if (cancelled) throw Cancelled();
}

template <class T>
void split(const T* points, size_t n, T* x, T* y, T* z) {
  for (size_t i = 0; i < n; ++i) {
    x[i] = points[3 * i];
    y[i] = points[3 * i + 1];
    z[i] = points[3 * i + 2];
  }
}

template <class T>
void evaluate_points(const Tape& tape, const T* points, size_t n, T* out,
                     const Progress& progress) {
  const size_t outputs = tape.outputs().size();
  for_blocks(n, progress, [&](size_t first, size_t count) {
    T xyz[3][block_size];
    split(points + 3 * first, count, xyz[0], xyz[1], xyz[2]);
    const T* at[3] = {xyz[0], xyz[1], xyz[2]};
    if (outputs == 1) {
      T* to = out + first;
      evaluate_block(tape, at, count, &to);
      return;
    }
    thread_local Scratch<T> storage;
    T* rows = storage.get(outputs * block_size);
    thread_local std::vector<T*> to;
    to.resize(outputs);
    for (size_t k = 0; k < outputs; ++k) to[k] = rows + k * block_size;
    evaluate_block(tape, at, count, to.data());
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < outputs; ++k) out[(first + i) * outputs + k] = to[k][i];
    }
  });
}

template <class T>
void gradients_at_points(const Tape& tape, const T* points, size_t n, T* out, T* gradient) {
  for_blocks(n, {}, [&](size_t first, size_t count) {
    T xyz[3][block_size], slope[3][block_size];
    split(points + 3 * first, count, xyz[0], xyz[1], xyz[2]);
    const T* at[3] = {xyz[0], xyz[1], xyz[2]};
    T* to[3] = {slope[0], slope[1], slope[2]};
    gradient_of_block(tape, at, count, out ? out + first : nullptr, to);
    for (size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis) gradient[3 * (first + i) + axis] = slope[axis][i];
    }
  });
}

// Runs the tape on values of another number type, one register each.
template <class T, class Step>
std::vector<T> run_registers(const Tape& tape, const std::array<T, 3>& xyz, Step step) {
  std::vector<T> registers(tape.registers());
  std::copy(xyz.begin(), xyz.end(), registers.begin());
  for (const Tape::Constant& c : tape.constants()) registers[c.reg] = step.constant(c.value);
  std::array<T, max_arity> in;
  for (const Instruction& i : tape.instructions()) {
    for (int k = 0; k < i.operation->info().arity; ++k) in[k] = registers[i.in[k]];
    registers[i.out] = step(*i.operation, in.data());
  }
  return registers;
}

struct ValueStep {
  static double constant(double a) { return a; }
  double operator()(const Operation& op, const double* in) const { return op.evaluate(in); }
};
struct IntervalStep {
  static Interval constant(double a) { return a; }
  Interval operator()(const Operation& op, const Interval* in) const { return op.interval(in); }
};
struct SlopeStep {
  static Slope constant(double a) { return {a, {}, 0}; }
  Slope operator()(const Operation& op, const Slope* in) const { return op.slope(in); }
};

}  // namespace

void Evaluator::values(const Vec3& point, double* out) const {
  const auto registers = run_registers<double>(tape_, point, ValueStep{});
  for (size_t k = 0; k < outputs(); ++k) out[k] = registers[tape_.outputs()[k]];
}

double Evaluator::value(const Vec3& point) const {
  return run_registers<double>(tape_, point, ValueStep{})[tape_.outputs()[0]];
}

void Evaluator::values(const double* points, size_t n, double* out,
                       const Progress& progress) const {
  evaluate_points(tape_, points, n, out, progress);
}
void Evaluator::values(const float* points, size_t n, float* out, const Progress& progress) const {
  evaluate_points(tape_, points, n, out, progress);
}
bool Evaluator::has_gradients() const {
  const std::vector<Instruction>& steps = tape_.instructions();
  return std::all_of(steps.begin(), steps.end(), [](const Instruction& step) {
    return step.operation->no_derivatives().empty();
  });
}

void Evaluator::gradients(const double* points, size_t n, double* out, double* gradient) const {
  gradients_at_points(tape_, points, n, out, gradient);
}
void Evaluator::gradients(const float* points, size_t n, float* out, float* gradient) const {
  gradients_at_points(tape_, points, n, out, gradient);
}

void Evaluator::block(const float* x, const float* y, const float* z, size_t n,
                      float* const* out) const {
  const float* xyz[3] = {x, y, z};
  evaluate_block(tape_, xyz, n, out);
}
void Evaluator::block(const double* x, const double* y, const double* z, size_t n,
                      double* const* out) const {
  const double* xyz[3] = {x, y, z};
  evaluate_block(tape_, xyz, n, out);
}
void Evaluator::gradient_block(const float* x, const float* y, const float* z, size_t n, float* out,
                               float* const* gradient) const {
  const float* xyz[3] = {x, y, z};
  gradient_of_block(tape_, xyz, n, out, gradient);
}
void Evaluator::gradient_block(const double* x, const double* y, const double* z, size_t n,
                               double* out, double* const* gradient) const {
  const double* xyz[3] = {x, y, z};
  gradient_of_block(tape_, xyz, n, out, gradient);
}

void Evaluator::intervals(const BoundingBox& box, Interval* out) const {
  const std::array<Interval, 3> xyz{Interval{box.lo[0], box.hi[0]}, Interval{box.lo[1], box.hi[1]},
                                    Interval{box.lo[2], box.hi[2]}};
  const auto registers = run_registers<Interval>(tape_, xyz, IntervalStep{});
  for (size_t k = 0; k < outputs(); ++k) out[k] = registers[tape_.outputs()[k]];
}

Interval Evaluator::interval(const BoundingBox& box) const {
  std::vector<Interval> all(outputs());
  intervals(box, all.data());
  return all[0];
}

Slope Evaluator::slope(const BoundingBox& box) const {
  std::array<Slope, 3> xyz;
  for (int axis = 0; axis < 3; ++axis) {
    xyz[axis].value = {box.lo[axis], box.hi[axis]};
    xyz[axis].partial[axis] = 1;
    xyz[axis].length = 1;
  }
  return run_registers<Slope>(tape_, xyz, SlopeStep{})[tape_.outputs()[0]];
}

}  // namespace sardf
