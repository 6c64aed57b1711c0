// The bulk kernels of an operation and the choice of the instruction set at run time.
//
// kernels_avx2.cpp and kernels_avx512.cpp instantiate make_kernels for the whole operation list
// with wider lanes; an operation outside the list (a test's) runs on the lanes of its own source
// file.
//
// All sets give the same bits, 0 ulp apart (which of the NaNs a NaN is aside): every step is
// rounded by IEEE 754, contraction is off, and elementary functions are such steps or the C
// library's scalar functions.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "sardf/numbers/gradient.hpp"
#include "sardf/numbers/lanes.hpp"
#include "sardf/operation.hpp"

namespace sardf {

enum class InstructionSet { baseline, avx2, avx512 };

/// The widest set that this processor has and that $SARDF_INSTRUCTION_SET ("baseline", "avx2",
/// "avx512") allows; decided once. A value that is none of the three is an Error.
InstructionSet instruction_set();
std::string instruction_set_name(InstructionSet set);

/// The inputs of an operation, lanes by lanes.
template <class L, int arity>
struct InputsOf {
  using Pointers = std::array<const float*, arity>;
  using Point = std::array<L, arity>;

  static Pointers pointers(const float* const* in) {
    Pointers from;
    for (int k = 0; k < arity; ++k) from[k] = in[k];
    return from;
  }
  static Point load(const Pointers& from, size_t i) {
    Point at;
    for (int k = 0; k < arity; ++k) at[k] = L::load(from[k] + i);
    return at;
  }
};

/// The kernel of a family of operations. Op::Family is Op itself or its base, and has
///   static constexpr int arity, together;     how many operations are evaluated by one call
///   template <class T, class Put>
///   static void results(const Family* ops, const std::array<T, arity>& in, Put put);
///                                             put(result, k) for each of ops, with its very bits;
///                                             an array of results would go through memory
template <class Family, class Isa>
struct TogetherOf {
  using L = Lanes<Isa>;
  using Inputs = InputsOf<L, Family::arity>;
  static constexpr int size = Family::together;
  static_assert(size <= most_together);
  // Objects of the family are read as its own.
  static_assert(std::is_standard_layout_v<Family> && std::is_trivially_copyable_v<Family>);

  static void value(const void* const* objects, const float* const* in, float* const* out,
                    size_t n) {
    Family ops[size];
    const typename Inputs::Pointers from = Inputs::pointers(in);
    std::array<float*, size> to;
    for (int k = 0; k < size; ++k) {
      ops[k] = *static_cast<const Family*>(objects[k]);
      to[k] = out[k];
    }
    for (size_t i = 0; i < n; i += L::width) {
      Family::results(ops, Inputs::load(from, i),
                      [&](const L& result, size_t k) { result.store(to[k] + i); });
    }
  }

  static constexpr Together table{&value, size};
};

template <class Op>
concept HasFamily = requires { typename Op::Family; };

template <class Op, class Isa>
struct FusedOf;

/// Solids that are alike but for their middles: with the coordinates x, ... of a point,
///   middle()            an array: where the middle is in the first of the coordinates
///   at_distance(d, x, ...)
///                       the value at the distance d from the middle. It never grows with d, and
///                       eval is at_distance(length(x - middle()[0], ...), x, ...)
///   is_alike(other)     whether `other` has the same at_distance
template <class Op>
concept HasMiddle = requires(const Op& op) { op.middle(); };

/// Operations of two values whose result is one of them, in every bit; and those that tell where it
/// is the first one (ops_blends.hpp).
template <class Op>
concept Selects = requires { Op::selects; };
template <class Op, class L>
concept Keeps = requires(const Op& op, L x) { op.keeps(x, x); };

template <class Op, class Isa>
struct KernelsOf {
  static constexpr int arity = Op::arity;
  using L = Lanes<Isa>;
  // A copy stays in registers, since results cannot be written to it; so do those of pointers.
  using Own = std::conditional_t<std::is_trivially_copyable_v<Op>, Op, const Op&>;

  using Inputs = InputsOf<L, arity>;

  static L call(const Op& op, const typename Inputs::Point& at) {
    return std::apply([&](auto... x) { return op.template eval<L>(x...); }, at);
  }

  static void value(const void* object, const float* const* in, float* out, size_t n) {
    const Own op = *static_cast<const Op*>(object);
    const typename Inputs::Pointers from = Inputs::pointers(in);
    for (size_t i = 0; i < n; i += L::width) call(op, Inputs::load(from, i)).store(out + i);
  }

  static void partials(const void* object, const float* const* in, float* out,
                       float* const* partial, size_t n) {
    partials_of(object, in, out, partial, n, std::make_index_sequence<arity>());
  }

  template <size_t... I>
  static void partials_of(const void* object, const float* const* in, float* out,
                          float* const* partial, size_t n, std::index_sequence<I...>) {
    using Dual = Gradient<L, arity>;
    const Own op = *static_cast<const Op*>(object);
    // Operations without inputs use neither.
    [[maybe_unused]] const std::array<const float*, arity> from{in[I]...};
    [[maybe_unused]] const std::array<float*, arity> to{partial[I]...};
    for (size_t i = 0; i < n; i += L::width) {
      const Dual result = op.template eval<Dual>(Dual::variable(L::load(from[I] + i), int(I))...);
      result.v.store(out + i);
      (result.d[I].store(to[I] + i), ...);
    }
  }

  static constexpr Kernels make_table() {
    Kernels made{&value, &partials};
    if constexpr (requires { typename Op::FusedWith; }) made.fused = FusedOf<Op, Isa>::table;
    if constexpr (HasFamily<Op>) {
      static_assert(std::is_standard_layout_v<Op>);
      made.together = &TogetherOf<typename Op::Family, Isa>::table;
    }
    if constexpr (requires { Op::place; }) made.place = Op::place;
    return made;
  }
  static constexpr Kernels table = make_table();
};

/// The kernel of several solids, each joined to the result before by the same operation, with one
/// root for all where that does: rounding keeps the order of numbers, so the least root is that of
/// the least square, and the largest of the solids' values is that of the nearest middle. A minimum
/// or maximum of all is that with this one; and where a blend leaves the result before as it is for
/// this one, it does so for the others. In every bit it is what one after the other gives.
template <class Op, class Isa>
struct SeveralOf {
  using L = Lanes<Isa>;
  using Inputs = InputsOf<L, Op::arity>;
  using Point = typename Inputs::Point;
  using Middle = std::array<float, std::tuple_size_v<decltype(std::declval<Op>().middle())>>;

  template <class Next>
  static void value(const void* const* objects, size_t count, const void* next_object,
                    const float* const* in, const float* first, float* out, size_t n) {
    const Op op = *static_cast<const Op*>(objects[0]);
    const Next next = *static_cast<const Next*>(next_object);
    std::array<Middle, most_pairs> middles;
    for (size_t m = 0; m < count; ++m) middles[m] = middle(objects[m]);
    const typename Inputs::Pointers from = Inputs::pointers(in);
    for (size_t i = 0; i < n; i += L::width) {
      const Point at = Inputs::load(from, i);
      L square = squared_distance(at, middles[0]);
      for (size_t m = 1; m < count; ++m) {
        const L other = squared_distance(at, middles[m]);
        square = Next::join == Join::intersection ? max(square, other) : min(square, other);
      }
      const L outermost = value_at(op, at, square);
      L result = L::load(first + i);
      if constexpr (Selects<Next>) {
        result = next.template eval<L>(result, outermost);
      } else if (!all(next.keeps(result, outermost))) {
        for (size_t m = 0; m < count; ++m)
          result =
              next.template eval<L>(result, value_at(op, at, squared_distance(at, middles[m])));
      }
      result.store(out + i);
    }
  }

  /// An infinite coordinate of one middle would make NaN of its solid only.
  static bool alike(const void* a, const void* b) {
    return is_finite(middle(a)) && is_finite(middle(b)) &&
           static_cast<const Op*>(a)->is_alike(*static_cast<const Op*>(b));
  }

 private:
  static Middle middle(const void* object) {
    const auto exact = static_cast<const Op*>(object)->middle();
    Middle at;
    for (size_t k = 0; k < at.size(); ++k) at[k] = float(exact[k]);
    return at;
  }
  static bool is_finite(const Middle& at) {
    bool every = true;
    for (size_t k = 0; k < at.size(); ++k) every = every && std::isfinite(at[k]);
    return every;
  }

  static L value_at(const Op& op, const Point& at, L square) {
    const L distance = sqrt(square);
    return std::apply([&](auto... x) { return op.at_distance(distance, x...); }, at);
  }

  // The steps of `length`.
  static L squared_distance(const Point& at, const Middle& middle) {
    L sum = square(at[0] - L(middle[0]));
    for (size_t k = 1; k < middle.size(); ++k) sum = sum + square(at[k] - L(middle[k]));
    return sum;
  }
};

/// The kernels of an operation with each of the list Op::FusedWith, those that often take its
/// result as the second input.
template <class Op, class Isa>
struct FusedOf {
  using Alone = KernelsOf<Op, Isa>;
  using L = typename Alone::L;
  using Inputs = typename Alone::Inputs;

  template <class Next>
  static void value(const void* object, const void* next_object, const float* const* in,
                    const float* first, float* out, size_t n) {
    const typename Alone::Own op = *static_cast<const Op*>(object);
    const Next next = *static_cast<const Next*>(next_object);
    const typename Inputs::Pointers from = Inputs::pointers(in);
    for (size_t i = 0; i < n; i += L::width) {
      const L second = Alone::call(op, Inputs::load(from, i));
      next.template eval<L>(L::load(first + i), second).store(out + i);
    }
  }

  template <class Next>
  static constexpr Fused fused() {
    Fused made{nullptr, &KernelsOf<Next, Isa>::value};
    // Beside the arcs of a blend too few registers are left: two passes take less time.
    if constexpr (Selects<Next>) made.value = &value<Next>;
    if constexpr (HasMiddle<Op> && (Selects<Next> || Keeps<Next, L>)) {
      made.several = &SeveralOf<Op, Isa>::template value<Next>;
      made.alike = &SeveralOf<Op, Isa>::alike;
    }
    return made;
  }
  template <template <class...> class List, class... Next>
  static constexpr std::array<Fused, sizeof...(Next)> make_table(
      std::type_identity<List<Next...>>) {
    return {fused<Next>()...};
  }
  static constexpr auto table = make_table(std::type_identity<typename Op::FusedWith>());
};

/// One term of the chain rule: outer = by * inner, or outer += by * inner, for n points, n a
/// multiple of 16. A `by` of 0 makes the term 0 whatever `inner` is, since the gradient of a branch
/// that is not taken may be NaN. `inner` nullptr stands for ones.
using ChainKernel = void (*)(const float* by, const float* inner, float* outer, size_t n, bool add);

template <class Isa>
void chain_term(const float* by, const float* inner, float* outer, size_t n, bool add) {
  using L = Lanes<Isa>;
  for (size_t i = 0; i < n; i += L::width) {
    const L factor = L::load(by + i);
    L term = factor;
    if (inner) {
      const auto is_zero = factor <= L(0.0) && factor >= L(0.0);
      term = select(is_zero, L(0.0), factor * L::load(inner + i));
    }
    (add ? L::load(outer + i) + term : term).store(outer + i);
  }
}

/// The one that this machine runs.
ChainKernel chain_kernel();

/// Kernels of a listed operation for an instruction set; nullptr where this build has none or the
/// operation is not in the list.
const Kernels* listed_kernels(InstructionSet set, const std::string& operation);

/// The kernels of Op that this machine runs.
template <class Op>
const Kernels& best_kernels() {
  static const Kernels& best = [&]() -> const Kernels& {
    const Kernels* listed = listed_kernels(instruction_set(), Op::name);
    return listed ? *listed : KernelsOf<Op, Baseline>::table;
  }();
  return best;
}

}  // namespace sardf
