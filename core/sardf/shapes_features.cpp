#include "sardf/shapes_features.hpp"

#include <unordered_set>

#include "sardf/arithmetic.hpp"
#include "sardf/curve_set.hpp"
#include "sardf/field_parts.hpp"
#include "sardf/surface_set.hpp"

namespace sardf {

namespace {

Expression distance_to(PointSetPointer set) {
  const std::array<Expression, 3> xyz{coordinate(0), coordinate(1), coordinate(2)};
  return call(distance_operation(std::move(set)), xyz);
}

// The constructor of the solid that a field is, or is made of without a feature in between; null
// where there is none. A formula is what its author says it is.
const Constructor* solid_in(const Field& field) {
  std::vector<Field> waiting{field};
  std::unordered_set<const Construction*> known;
  while (!waiting.empty()) {
    const Construction* made = waiting.back().construction();
    waiting.pop_back();
    if (!made || !made->constructor || !known.insert(made).second) continue;
    const std::string& group = made->constructor->group;
    if (group == "solid" || group == "plane") return made->constructor;
    if (group == "feature") continue;
    for (const Value& argument : made->arguments) append_fields(argument, waiting);
  }
  return nullptr;
}

}  // namespace

Expression BSplineCurve::expression() const {
  return distance_to(std::make_shared<CurveSet>(
      name, doc, CurveData{control_points, degree, knots, weights, closed}));
}

Expression BSplineSurface::expression() const {
  return distance_to(
      std::make_shared<SurfaceSet>(name, doc,
                                   SurfaceData{control_points, degree_u, degree_v, knots_u, knots_v,
                                               weights, closed_u, closed_v}));
}

Expression Skeleton::expression() const {
  Expression nearest;
  for (size_t i = 0; i < of.size(); ++i) {
    if (const Constructor* solid = solid_in(of[i])) {
      throw Error("element " + std::to_string(i) + " of the skeleton is made of '" + solid->name +
                  "', a " + solid->group + (solid->group == "plane" ? " field" : "") +
                  "; features are accepted, such as {\"boundary\": {\"solid\": ...}} of a solid");
    }
    nearest = i == 0 ? of[i].expression() : min(nearest, of[i].expression());
  }
  return nearest;
}

Quality Skeleton::quality() const {
  Exactness worst = Exactness::exact;
  for (const Field& field : of) {
    worst = std::max({worst, field.quality().inside, field.quality().outside});
  }
  return {worst, worst};
}

}  // namespace sardf
