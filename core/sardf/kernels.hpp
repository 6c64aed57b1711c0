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
#include <string>
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

/// The kernel of a family of operations. Op::Family is Op itself or its base, and has
///   static constexpr int arity, together;     how many operations are evaluated by one call
///   template <class T, class Put>
///   static void results(const Family* ops, const std::array<T, arity>& in, Put put);
///                                             put(result, k) for each of ops, with its very bits;
///                                             an array of results would go through memory
template <class Family, class Isa>
struct TogetherOf {
  using L = Lanes<Isa>;
  static constexpr int size = Family::together;
  static_assert(size <= most_together);
  // Objects of the family are read as its own.
  static_assert(std::is_standard_layout_v<Family> && std::is_trivially_copyable_v<Family>);

  static void value(const void* const* objects, const float* const* in, float* const* out,
                    size_t n) {
    Family ops[size];
    std::array<const float*, Family::arity> from;
    std::array<float*, size> to;
    for (int k = 0; k < Family::arity; ++k) from[k] = in[k];
    for (int k = 0; k < size; ++k) {
      ops[k] = *static_cast<const Family*>(objects[k]);
      to[k] = out[k];
    }
    for (size_t i = 0; i < n; i += L::width) {
      std::array<L, Family::arity> at;
      for (int k = 0; k < Family::arity; ++k) at[k] = L::load(from[k] + i);
      Family::results(ops, at, [&](const L& result, size_t k) { result.store(to[k] + i); });
    }
  }

  static constexpr Together table{&value, size};
};

template <class Op>
concept HasFamily = requires { typename Op::Family; };

template <class Op, class Isa>
struct FusedOf;

template <class Op, class Isa>
struct KernelsOf {
  static constexpr int arity = Op::arity;
  using L = Lanes<Isa>;
  // A copy stays in registers, since results cannot be written to it; so do those of pointers.
  using Own = std::conditional_t<std::is_trivially_copyable_v<Op>, Op, const Op&>;

  template <class T, size_t... I>
  static T call(const Op& op, const T* in, std::index_sequence<I...>) {
    return op.template eval<T>(in[I]...);
  }

  static void value(const void* object, const float* const* in, float* out, size_t n) {
    const Own op = *static_cast<const Op*>(object);
    std::array<const float*, arity> from;
    for (int k = 0; k < arity; ++k) from[k] = in[k];
    for (size_t i = 0; i < n; i += L::width) {
      std::array<L, arity> at;
      for (int k = 0; k < arity; ++k) at[k] = L::load(from[k] + i);
      call(op, at.data(), std::make_index_sequence<arity>()).store(out + i);
    }
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

/// The kernels of an operation with each of the list Op::FusedWith, operations of two inputs that
/// often take its result as the second.
template <class Op, class Isa>
struct FusedOf {
  using Alone = KernelsOf<Op, Isa>;
  using L = typename Alone::L;

  template <class Next>
  static void value(const void* object, const void* next_object, const float* const* in,
                    const float* first, float* out, size_t n) {
    const typename Alone::Own op = *static_cast<const Op*>(object);
    const typename KernelsOf<Next, Isa>::Own next = *static_cast<const Next*>(next_object);
    std::array<const float*, Alone::arity> from;
    for (int k = 0; k < Alone::arity; ++k) from[k] = in[k];
    for (size_t i = 0; i < n; i += L::width) {
      std::array<L, Alone::arity> at;
      for (int k = 0; k < Alone::arity; ++k) at[k] = L::load(from[k] + i);
      const L second = Alone::call(op, at.data(), std::make_index_sequence<Alone::arity>());
      next.template eval<L>(L::load(first + i), second).store(out + i);
    }
  }

  template <template <class...> class List, class... Next>
  static constexpr std::array<Fused, sizeof...(Next)> make_table(
      std::type_identity<List<Next...>>) {
    return {Fused{&value<Next>, &KernelsOf<Next, Isa>::value}...};
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
