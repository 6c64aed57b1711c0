#include "povray_gen/sampler.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include "sardf/certify.hpp"
#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

// Null where none is known: of second derivatives of a distance that is found by a search.
Expression derivative_or_null(const Operation& operation, int axis,
                              std::span<const Expression> inputs) {
  try {
    return operation.derivative(axis, inputs);
  } catch (const Error&) {
    return nullptr;
  }
}

constexpr double first_samples = 36000;
// Where a function jumps no grid makes the error small; the jump lies within a cell of this one.
constexpr double most_samples_of_jumps = 2.2e6;
constexpr int most_along_axis = 65534;
// An input that changes by less of its size is constant but for rounding, as far as a picture
// shows: difference quotients along it would be those of the rounding.
constexpr double thin = 1e-7;
constexpr size_t points_at_once = 1024;
constexpr size_t bent_samples = 1024, other_cells = 8192;

constexpr const char* input_names = "xyz";

Expression of_coordinates(const OperationPointer& operation) {
  std::vector<Expression> inputs;
  for (int k = 0; k < operation->info().arity; ++k) inputs.push_back(coordinate(k));
  return call(operation, inputs);
}

// Centres of the cells, of their faces, and a random point in each.
class Probes {
 public:
  explicit Probes(const SampleGrid& grid) : grid_(grid), cells_(grid) {
    for (int& count : cells_.counts) count = std::max(1, count - 1);
  }

  void add_around(size_t sample) {
    const std::array<int, 3> p = grid_.position(sample);
    for (int corner = 0; corner < 8; ++corner) {
      std::array<int, 3> cell = p;
      bool exists = true;
      for (int k = 0; k < 3; ++k) {
        cell[k] -= corner >> k & 1;
        exists = exists && 0 <= cell[k] && cell[k] < cells_.counts[k];
      }
      if (exists) add(cell);
    }
  }

  // All cells where they are few.
  void add_others(size_t count) {
    const size_t all = cells_.size();
    for (size_t i = 0; i < std::min(count, all); ++i) {
      add(cells_.position(all <= count ? i : size_t(random_() % all)));
    }
  }

  const std::vector<Vec3>& points() const { return points_; }

 private:
  void add(const std::array<int, 3>& cell) {
    Vec3 low, center, random;
    for (int k = 0; k < 3; ++k) {
      low[k] = cell[k];
      center[k] = low[k] + (grid_.varies(k) ? 0.5 : 0);
      random[k] = low[k] + (grid_.varies(k) ? double(random_() >> 11) * 0x1p-53 : 0);
    }
    points_.push_back(grid_.place(center));
    points_.push_back(grid_.place(random));
    for (int k = 0; k < 3; ++k) {
      if (!grid_.varies(k)) continue;
      Vec3 face = center;
      face[k] = low[k];
      points_.push_back(grid_.place(face));
    }
  }

  SampleGrid grid_, cells_;
  std::mt19937_64 random_{1};
  std::vector<Vec3> points_;
};

}  // namespace

Sampler::Sampler(OperationPointer operation, const std::array<Interval, 3>& box)
    : operation_(std::move(operation)), box_(box) {
  const OperationInfo& info = operation_->info();
  if (info.arity > 3) {
    throw Error("'" + info.name + "' has no formula and " + std::to_string(info.arity) +
                " inputs; POV-Ray can evaluate samples of at most three");
  }
  evaluator_ = Evaluator(of_coordinates(operation_));
  const BoundingBox all{{box[0].lo, box[1].lo, box[2].lo}, {box[0].hi, box[1].hi, box[2].hi}};
  lipschitz_ = lipschitz_bound(evaluator_, all);
  std::vector<Expression> inputs;
  for (int k = 0; k < info.arity; ++k) inputs.push_back(coordinate(k));
  curvature_.fill(0);
  for (int k = 0; k < info.arity; ++k) {
    // That of a distance has no bound wherever there is a kink.
    const Expression slope =
        operation_->is_distance() ? nullptr : derivative_or_null(*operation_, k, inputs);
    curvature_[size_t(k)] = slope ? lipschitz_bound(Evaluator(slope), all) : infinity;
  }
}

SampleGrid Sampler::grid_of(double step) const {
  SampleGrid grid{box_, {1, 1, 1}};
  double longest = 0;
  for (const Interval& side : box_) longest = max(longest, side.hi - side.lo);
  for (int k = 0; k < 3; ++k) {
    const double width = box_[k].hi - box_[k].lo;
    const bool lengths = operation_->is_distance();
    if (!(width > thin * max(box_[k].magnitude(), lengths ? longest : 0.0))) continue;
    const double share = lengths ? width / longest : 1;
    grid.counts[k] = int(std::clamp(std::ceil(share / step) + 1, 2.0, double(most_along_axis)));
  }
  return grid;
}

double Sampler::finest_step(double most_samples) const {
  double low = 1.0 / most_along_axis, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = std::sqrt(low * high);
    (grid_of(middle).stored_size() <= most_samples ? high : low) = middle;
  }
  return high;
}

// Large arrays are not filled with zeros first: that alone would take longer than a cancel may.
std::unique_ptr<double[]> Sampler::values(size_t n, const std::function<Vec3(size_t)>& point,
                                          Work& work) const {
  constexpr size_t block = Evaluator::block_size;
  auto out = std::make_unique_for_overwrite<double[]>(n);
  std::atomic<size_t> bad{n};
  work.run(n, points_at_once, [&](size_t first, size_t last) {
    std::array<std::array<double, block>, 3> at;
    for (size_t i = first; i < last; i += block) {
      const size_t count = std::min(block, last - i);
      for (size_t j = 0; j < count; ++j) {
        const Vec3 p = point(i + j);
        for (int k = 0; k < 3; ++k) at[k][j] = p[k];
      }
      double* to = &out[i];
      evaluator_.block(at[0].data(), at[1].data(), at[2].data(), count, &to);
      for (size_t j = i; j < i + count; ++j) {
        size_t first_bad = bad;
        while (!std::isfinite(out[j]) && j < first_bad &&
               !bad.compare_exchange_weak(first_bad, j)) {
        }
      }
    }
  });
  if (bad < n) complain_of(point(bad));
  return out;
}

void Sampler::complain_of(const Vec3& point) const {
  std::string place;
  for (int k = 0; k < operation_->info().arity; ++k) {
    place += (k ? ", " : "") + std::string(1, input_names[k]) + " = " + std::to_string(point[k]);
  }
  throw Error("'" + operation_->info().name + "' has no formula, and for its samples no finite " +
              "value where its inputs are " + place);
}

// The interpolated value at p is a mean of the cell's corners' with the weights of p, so
// for a function of slope <= L it is off by at most L × the mean distance of the corners from p.
// That is at most the root of the mean square, sqrt(sum over axes of t (1 - t) h²) for a point at
// the share t of a side h: no more than half of the cell's diagonal. Along a thin axis all samples
// lie at one end. Where second derivatives are bounded: interpolation along one axis is off by at
// most an eighth of that along it times h², and does not enlarge the errors of those before it.
double Sampler::proven_error(const SampleGrid& grid) const {
  double squares = 0, bends = 0, thin_squares = 0;
  for (int k = 0; k < 3; ++k) {
    const double width = box_[k].hi - box_[k].lo;
    const double most = grid.varies(k) ? 0.5 * grid.step(k) : width;
    squares += most * most;
    if (grid.varies(k)) {
      bends += curvature_[size_t(k)] * grid.step(k) * grid.step(k) / 8;
    } else {
      thin_squares += width * width;
    }
  }
  const double thin_part = thin_squares > 0 ? lipschitz_ * std::sqrt(thin_squares) : 0;
  return min(lipschitz_ * std::sqrt(squares), thin_part + bends);
}

// The function itself is exact to 1e-9, its samples are rounded.
SampleError Sampler::error_of(const Samples& samples, Work& work) const {
  const SampleGrid& grid = samples.grid();
  Probes probes(grid);
  for (size_t sample : samples.most_bent(bent_samples, work)) probes.add_around(sample);
  probes.add_others(other_cells);
  const std::vector<Vec3>& points = probes.points();
  const auto exact = values(
      points.size(), [&](size_t i) { return points[i]; }, work);
  SampleError error;
  error.points = points.size();
  for (size_t i = 0; i < points.size(); ++i) {
    error.measured = max(error.measured, std::abs(samples.value(points[i], nullptr) - exact[i]));
  }
  error.measured += samples.rounding();
  error.proven =
      rounded_up(proven_error(grid) + samples.rounding() + 1e-8 * samples.range().magnitude(), 16);
  return error;
}

Sampler::Result Sampler::sample(double aimed, double most_samples, Work& work,
                                double progress_end) {
  const double begin = work.end();
  double finest = finest_step(most_samples);
  double step = max(finest, finest_step(min(first_samples, most_samples)));
  double shrunk = 0, before = infinity;
  for (;;) {
    const SampleGrid grid = grid_of(step);
    work.stage(begin + (progress_end - begin) * min(1.0, grid.stored_size() / most_samples));
    auto at_grid = values(
        grid.size(), [&](size_t i) { return grid.point(i); }, work);
    Result result;
    result.samples = std::make_shared<Samples>(grid, std::span(at_grid.get(), grid.size()), work);
    at_grid.reset();
    result.error = error_of(*result.samples, work);
    const Interval range = result.samples->range();
    result.error.aimed = operation_->is_distance() ? aimed : aimed * (range.hi - range.lo);
    const double measured = result.error.measured;
    // A continuous function's error shrinks at least as the step does.
    const bool jumps = !(lipschitz_ < infinity) && measured > before * 0.5 * (1 + shrunk);
    if (jumps) finest = max(finest, finest_step(most_samples_of_jumps));
    if (measured <= result.error.aimed || step <= finest) return result;
    shrunk = std::clamp(0.9 * result.error.aimed / measured, 0.5, 0.85);
    before = measured;
    step = max(finest, step * shrunk);
  }
}

}  // namespace sardf::povray
