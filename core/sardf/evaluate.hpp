// Evaluation of a tape: one point, many points (double, or float on SIMD lanes), boxes, gradients.
//
// Bulk evaluation works on blocks of 256 points with one scratch per thread; nothing is allocated
// per point, and results do not depend on the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sardf/progress.hpp"
#include "sardf/tape.hpp"

namespace sardf {

struct BoundingBox {
  Vec3 lo{}, hi{};
  Vec3 center() const { return 0.5 * (lo + hi); }
  Vec3 size() const { return hi - lo; }
  double diagonal() const { return norm(size()); }
};

/// Bytes. Lanes that lie across two cache lines cost twice.
inline constexpr size_t cache_line = 64;

/// Reusable storage of one thread's evaluations.
template <class T>
class Scratch {
 public:
  /// Room for n values, from the beginning of a cache line.
  T* get(size_t n) {
    constexpr size_t more = cache_line / sizeof(T);
    if (storage_.size() < n + more) storage_.resize(n + more);
    const size_t beyond = reinterpret_cast<uintptr_t>(storage_.data()) % cache_line;
    return storage_.data() + (beyond == 0 ? 0 : (cache_line - beyond) / sizeof(T));
  }

 private:
  std::vector<T> storage_;
};

class Evaluator {
 public:
  Evaluator() = default;
  explicit Evaluator(std::span<const Expression> outputs) : tape_(outputs) {}
  explicit Evaluator(const Expression& output) : tape_(output) {}
  explicit Evaluator(Tape tape) : tape_(std::move(tape)) {}

  const Tape& tape() const { return tape_; }
  size_t outputs() const { return tape_.outputs().size(); }

  /// First output at one point.
  double value(const Vec3& point) const;
  /// All outputs at one point; `out` has outputs() entries.
  void values(const Vec3& point, double* out) const;

  /// The exact path. points: n × 3, out: n × outputs(), row-major. Runs on all threads.
  void values(const double* points, size_t n, double* out, const Progress& progress = {}) const;
  /// The SIMD path; same layout.
  void values(const float* points, size_t n, float* out, const Progress& progress = {}) const;
  /// Whether every operation has derivatives; without, `gradients` throws Error.
  bool has_gradients() const;
  /// Values and gradients of the first output. gradient: n × 3. `out` may be nullptr.
  void gradients(const double* points, size_t n, double* out, double* gradient) const;
  void gradients(const float* points, size_t n, float* out, float* gradient) const;

  /// One block on the calling thread, for callers that run their own loops: coordinates as arrays,
  /// out[k] the array of output k, which overlaps no other one. n <= block_size; arrays need room
  /// for n only.
  static constexpr size_t block_size = 256;
  void block(const float* x, const float* y, const float* z, size_t n, float* const* out) const;
  void block(const double* x, const double* y, const double* z, size_t n, double* const* out) const;
  /// The same with the gradient of the first output: gradient[i] is the array of d/dx_i.
  void gradient_block(const float* x, const float* y, const float* z, size_t n, float* out,
                      float* const* gradient) const;
  void gradient_block(const double* x, const double* y, const double* z, size_t n, double* out,
                      double* const* gradient) const;

  /// Encloses each output over the box.
  void intervals(const BoundingBox& box, Interval* out) const;
  Interval interval(const BoundingBox& box) const;
  /// Values, partial derivatives and gradient length of the first output over the box.
  Slope slope(const BoundingBox& box) const;

 private:
  Tape tape_;
};

}  // namespace sardf
