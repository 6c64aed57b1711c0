// An operation as the engine sees it: the type-erased form of one struct of the operation list.
//
// OperationOf<Op> (operation_of.hpp) derives everything here from Op::eval<T>.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sardf/numbers/interval.hpp"
#include "sardf/numbers/trace.hpp"

namespace sardf {

/// Most inputs an operation has.
inline constexpr int max_arity = 4;

/// Where an operation appears.
enum class Kind {
  solid,     // signed field in space: a constructor
  plane,     // signed field of x and y: a constructor
  feature,   // unsigned distance to a set of points: a constructor
  function,  // a function of values: its name is a word of the formula language
  internal,  // what constructors build with
};

/// Which boolean of a blend an operation is.
enum class Join { none, intersection, unite, difference };

struct OperationInfo {
  std::string name;
  Kind kind;
  int arity;
  std::string doc;
};

/// Certified bounds of a field over a box: its values, its partial derivatives by x, y, z, and the
/// length of its gradient.
struct Slope {
  Interval value;
  std::array<Interval, 3> partial;
  double length = 0;
};

/// What a value can be over a box, in double and in float arithmetic.
struct Enclosure {
  Interval value;
  bool may_be_nan = false;
};

/// Which values of a result matter: all up to the floor are as good as one another, and so are all
/// from the ceiling on.
struct Demand {
  double floor = -infinity, ceiling = infinity;
  friend bool operator==(const Demand&, const Demand&) = default;
};

/// What becomes of an operation over a box: it is computed, or its result is a copy of an input or
/// a number, in every bit.
struct Fate {
  enum class Type : uint8_t { computed, copy, number };
  Type type = Type::computed;
  bool negated = false;
  int input = 0;
  double number = 0;
  /// If it is computed: what matters of each input.
  std::array<Demand, max_arity> demand;
};

/// Bulk evaluation of several operations of the same inputs by one call, for a family of operations
/// that share steps, or inputs that are read once.
struct Together {
  /// out[k] is the result of ops[k].
  using Value = void (*)(const void* const* ops, const float* const* in, float* const* out,
                         size_t n);
  Value value = nullptr;
  int size = 0;  // how many
};
/// Most operations that one call evaluates.
inline constexpr int most_together = 4;

/// Bulk evaluation of a solid and of an operation that takes its result as the second input, in one
/// pass: what lies between is not written.
struct Fused {
  /// out is the result of `next` of `first` and the result of `op`.
  using Value = void (*)(const void* op, const void* next, const float* const* in,
                         const float* first, float* out, size_t n);
  /// The same of several such pairs, at most most_pairs, each with the result of the one before as
  /// `first`, whose solids are alike.
  using Several = void (*)(const void* const* ops, size_t count, const void* next,
                           const float* const* in, const float* first, float* out, size_t n);
  /// Null where two passes take as long.
  Value value = nullptr;
  /// The kernel that `next` has alone, by which it is known.
  void (*next)(const void* op, const float* const* in, float* out, size_t n) = nullptr;
  /// Null where several take as long as one after the other.
  Several several = nullptr;
  /// Whether two solids are alike: they differ in their middles only.
  bool (*alike)(const void* a, const void* b) = nullptr;
};
/// Most pairs that one call evaluates.
inline constexpr size_t most_pairs = 32;

/// Bulk evaluation of n points, n a multiple of 16. `in` and `out` are arrays of n.
struct Kernels {
  using Value = void (*)(const void* op, const float* const* in, float* out, size_t n);
  /// Also the derivatives by each input: partial[i] is an array of n.
  using Partials = void (*)(const void* op, const float* const* in, float* out,
                            float* const* partial, size_t n);
  Value value = nullptr;
  Partials partials = nullptr;
  /// How it is evaluated with others of its family; null where it has none.
  const Together* together = nullptr;
  /// Its place among them, where they are parts of one formula and have equal parameters; -1 where
  /// any of the family will do.
  int place = -1;
  /// How it is evaluated with operations that take its result.
  std::span<const Fused> fused{};

  /// How it is evaluated with one that has these kernels and takes its result; null where it is
  /// not.
  const Fused* fused_with(const Kernels& next) const {
    for (const Fused& candidate : fused) {
      if (candidate.next == next.value) return &candidate;
    }
    return nullptr;
  }
};

class Operation;
using OperationPointer = std::shared_ptr<const Operation>;

struct Node;
/// A handle to an immutable node of a graph (graph.hpp).
using Expression = std::shared_ptr<const Node>;

class Operation {
 public:
  virtual ~Operation() = default;

  virtual const OperationInfo& info() const = 0;
  /// The parameters as numbers; two operations of one name and equal numbers are the same.
  virtual const std::vector<double>& numbers() const = 0;
  /// The largest magnitude of its parameters that are measured as its arguments and results are:
  /// with these, what the rounding of single precision is a share of.
  virtual double scale() const = 0;

  virtual double evaluate(const double* in) const = 0;
  virtual void evaluate(const double* const* in, double* out, size_t n) const = 0;
  virtual void partials(const double* const* in, double* out, double* const* partial,
                        size_t n) const = 0;
  virtual const Kernels& kernels() const = 0;
  /// The object that the kernels take.
  virtual const void* object() const = 0;

  /// Encloses the double result over all inputs in the intervals.
  virtual Interval interval(const Interval* in) const = 0;
  virtual Slope slope(const Slope* in) const = 0;
  /// Encloses the double and the float result over all inputs in the ranges.
  virtual Enclosure range(const Enclosure* in) const;
  /// What becomes of the operation over these ranges where `demand` is what matters of its result.
  virtual Fate fate(const Enclosure* in, const Demand& demand) const;
  /// One that takes less work, with the same results in every bit over these ranges; null where
  /// none is known.
  virtual OperationPointer narrowed(const Enclosure*) const { return nullptr; }
  /// Bound of |result - result with min/max in place of the blend| for equal inputs.
  virtual double blend_error() const = 0;
  /// Bound of the sum of the absolute partial derivatives over all inputs in the intervals.
  virtual double gain(const Interval* in) const = 0;
  /// Whether it is the exact Euclidean distance in its inputs.
  virtual bool is_distance() const = 0;
  /// Whether it has second derivatives by its inputs wherever it has a value and they are finite.
  virtual bool is_smooth() const { return false; }
  virtual Join join() const = 0;

  /// Whether there is a formula: a field that carries data (data_operation.hpp) has none.
  virtual bool has_formula() const { return true; }
  /// Whether a value takes about as long as a formula's: not where something is searched for.
  virtual bool is_quick() const { return has_formula(); }
  /// Records the formula; the result's step is trace.result.
  virtual void record(Trace& trace) const = 0;
  /// Why `partials` throws Error, in one sentence; empty for all others.
  virtual std::string no_derivatives() const { return ""; }
  /// Of an operation without a formula, the partial derivative by input k as an expression of the
  /// inputs; null where that is not known.
  virtual Expression derivative(int k, std::span<const Expression> inputs) const;
};

}  // namespace sardf
