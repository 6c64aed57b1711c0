#include "shapes.hpp"

#include "sardf/constructor.hpp"
#include "sardf/fractions.hpp"
#include "sardf/inverse_shares.hpp"

namespace sardf::bench {

namespace {

Field box(const Vec3& center, const Vec3& size) { return make_field("box", {center, size}); }

Expression spheres() {
  std::vector<Field> all;
  for (int i = 0; i < 16; ++i) {
    all.push_back(make_field("sphere", {Vec3{0.5 * (i / 4 - 1.5), 0.5 * (i % 4 - 1.5), 0}, 0.3}));
  }
  const Field joined = make_field("union", {all, min_max_blend()});
  const std::vector<Field> of{joined, box({0, 0, 0.25}, {1.8, 0.5, 0.5})};
  return make_field("difference", {of, min_max_blend()}).expression();
}

Expression drilled_block(const BlendPointer& blend) {
  const auto hole = [](double x, double y, double radius) {
    return make_field("cylinder", {Vec3{x, y, 0}, Vec3{0, 0, 1}, radius, Value()});
  };
  const std::vector<Field> of{box({}, {20, 12, 8}), hole(0, 0, 3),  hole(-8, -4, 1),
                              hole(-8, 4, 1),       hole(8, -4, 1), hole(8, 4, 1)};
  const Field drilled = make_field("difference", {of, blend});
  const Field ring = make_field("torus", {Vec3{}, Vec3{0, 0, 1}, 5.0, 1.0});
  return make_field("union", {std::vector<Field>{drilled, ring}, blend}).expression();
}

}  // namespace

Expression shape(Shape which, const std::string& rounded) {
  if (which == Shape::spheres) return spheres();
  return drilled_block(which == Shape::block ? min_max_blend() : make_blend(rounded, {0.5}));
}

Graded graded_block(double exponent) {
  const std::vector<std::string> materials{"bore", "low", "high"};
  const Field hole = make_field("cylinder", {Vec3{}, Vec3{0, 0, 1}, 3.0, Value()});
  const std::vector<Field> at{make_field("boundary", {hole}),
                              make_field("point", {Vec3{10, -6, 4}}),
                              make_field("point", {Vec3{-10, 6, 4}})};
  std::vector<Record> features;
  for (size_t m = 0; m < 3; ++m)
    features.push_back({{at[m], Fractions::material(materials[m]), exponent, RuleValue()}});
  Graded made;
  made.fractions = lower(make_fractions("inverse_distance", {features}), materials,
                         bounds(Shape::blended_block).diagonal());
  for (const Vec3& of : {Vec3{0.1, 0.9, 0.3}, Vec3{0.2, 0.7, 0.6}, Vec3{0.3, 0.5, 0.9}}) {
    made.color.push_back(weighted_sum(made.fractions, of));
  }
  return made;
}

BoundingBox bounds(Shape which) {
  const Vec3 half = which == Shape::spheres ? Vec3{1.05, 1.05, 0.3} : Vec3{10, 6, 4};
  return {-1.1 * half, 1.1 * half};
}

std::string name(Shape which) {
  return which == Shape::spheres ? "spheres" : which == Shape::block ? "block" : "blended_block";
}

}  // namespace sardf::bench
