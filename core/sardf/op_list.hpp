// What an operation file needs, and the list type that its last line fills.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sardf/error.hpp"
#include "sardf/numbers/gradient.hpp"
#include "sardf/numbers/interval.hpp"
#include "sardf/numbers/real.hpp"
#include "sardf/operation.hpp"
#include "sardf/parameter.hpp"

namespace sardf {

template <class... Ops>
struct OpList {
  /// f(std::type_identity<Op>) for every operation, in order.
  template <class F>
  static void for_each(F f) {
    (f(std::type_identity<Ops>{}), ...);
  }
};

template <class... Lists>
struct Joined;
template <class... A>
struct Joined<OpList<A...>> {
  using type = OpList<A...>;
};
template <class... A, class... B, class... Rest>
struct Joined<OpList<A...>, OpList<B...>, Rest...> : Joined<OpList<A..., B...>, Rest...> {};

}  // namespace sardf
