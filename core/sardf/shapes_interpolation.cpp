#include "sardf/shapes_interpolation.hpp"

#include "sardf/fractions.hpp"

namespace sardf {

Expression ValueOf::expression() const {
  const Fractions fractions(rule);
  if (uses_rule(fractions, "of_materials")) {
    throw Error(
        "of_materials averages by a scene's fractions, which a field does not have; it is accepted "
        "in attributes only");
  }
  Lowering lowering;
  lowering.diagonal = scale;
  lowering.components = 1;
  return lower(fractions, lowering)[0];
}

}  // namespace sardf
