// A scene: a solid, what it is made of, and how it is shown. Scene files and Python both make one.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sardf/evaluate.hpp"
#include "sardf/field.hpp"
#include "sardf/fractions.hpp"
#include "sardf/progress.hpp"
#include "sardf/scene_checks.hpp"
#include "sardf/scene_source.hpp"

namespace sardf {

struct Material {
  std::string name;
  Vec3 color{0.8, 0.8, 0.8};  // linear Rec.709
  double roughness = 0.5;     // 0 to 1
  double metallic = 0;        // 0 to 1
  double index_of_refraction = 1.45;
  Vec3 emission{};                                            // linear, unbounded
  std::optional<double> density;                              // g/cm³
  std::vector<std::pair<std::string, std::string>> metadata;  // free: name, JSON text of the value
};

/// What can be baked of every scene; no attribute has such a name, or one that begins with
/// "fractions_", the name of an image of three materials.
struct CommonChannel {
  const char *name, *doc;
};
inline constexpr std::array<CommonChannel, 7> common_channels{{
    {"base_color", "the materials' colours, mixed by the fractions; linear"},
    {"roughness", "the materials' roughness, 0 to 1"},
    {"metallic", "how far the materials are metal, 0 to 1"},
    {"emission", "the light that the materials give off; linear, unbounded"},
    {"fractions", "the materials' volume fractions as masks, three in an image"},
    {"field", "the solid's field, positive inside; 0 on the surface"},
    {"normal", "the solid's normals in the mesh's tangent space: a normal map"},
}};

/// A scalar (one component) or vector function on the object: a field for each component, or a
/// rule as for fractions, from which Scene makes the components.
struct Attribute {
  std::string name;
  std::string unit;  // free text
  std::vector<Field> components;
  Fractions rule;
  size_t rule_components = 1;
  std::vector<std::string> component_names;  // as of a tensor; empty: they have none
  /// Three components that are scaled to the length 1. Where none is larger than 1e-12 of the
  /// largest that any part of the rule prescribes at the point, the fallback counts.
  bool unit_vector = false;
  Vec3 fallback{0, 0, 1};

  /// What a table calls component c of n: the attribute itself where it is one, else the
  /// attribute's name, _, and the component's name or x, y, z, w.
  std::string column(size_t c, size_t n) const;
};

/// A cut: what is removed from the picture, except from the parts that are kept whole.
struct Section {
  Field remove;
  std::vector<Field> keep;
};

struct NamedField {
  std::string name;
  Field field;
};

/// How the picture is framed; see camera.hpp.
struct Framing {
  Vec3 direction{0.5, -0.78, 0.42};  // from the object towards the camera
};

/// What the user states. Make it ready with Scene(description).
struct SceneDescription {
  std::string title;
  std::string comment;
  std::string units = "mm";  // um, mm, cm, m, in
  std::vector<std::pair<std::string, double>> parameters;
  std::vector<NamedField> fields;  // in file order
  Field solid;
  /// Joins every boolean of the scene in place of its own blend; null: as each says.
  BlendPointer blend;
  std::vector<Material> materials;
  Fractions fractions;  // empty: the first material everywhere
  std::vector<Attribute> attributes;
  std::vector<Section> sections;
  std::optional<BoundingBox> stated_bounds;  // proven, not believed
  std::optional<double> stated_lipschitz;    // of the solid; believed, and labelled so
  Framing view;
  SceneSource source;
};

/// The units of length that a scene may have: um, mm, cm, m, in.
std::vector<std::string> unit_names();
/// Metres per unit; Error for an unknown unit.
double metres_per_unit(const std::string& units);

class Scene {
 public:
  /// Finds certified bounds and lowers everything to expressions. Throws Error: an empty or
  /// unbounded solid, a material named twice, fractions of unknown materials, ...
  explicit Scene(SceneDescription description, const Progress& progress = {});

  const SceneDescription& description() const { return description_; }
  std::vector<std::string> material_names() const;
  double metres_per_unit() const { return sardf::metres_per_unit(description_.units); }

  /// Certified: outside them the solid is proven empty. Padded by 1e-4 of the diagonal.
  const BoundingBox& bounds() const { return bounds_; }

  const Expression& solid() const { return solid_field_.expression(); }
  const Field& solid_field() const { return solid_field_; }
  /// The named fields, in file order.
  const std::vector<NamedField>& fields() const { return fields_; }
  /// The solid with its sections cut away: what is drawn.
  const Expression& drawn() const { return drawn_; }
  /// What the sections remove, joined: >= 0 where material was cut away. Null: none.
  const Expression& removed() const { return removed_; }

  /// One for each material, >= 0, their sum 1, defined in all of space.
  const std::vector<Expression>& fractions() const { return fractions_; }
  /// Σ fraction × material property; colours have 3 components, linear.
  std::array<Expression, 3> base_color() const;
  std::array<Expression, 3> emission() const;
  Expression roughness() const;
  Expression metallic() const;

  /// What is accepted but may not be what is meant: features that touch with contradicting values,
  /// functions that are not proven to lie in [0, 1]. Searches for seconds at most; throws
  /// Cancelled.
  std::vector<Warning> warnings(const Progress& progress = {}) const;

  /// fractions at n points (n × 3, row-major) into n × materials; rows are renormalised to sum 1.
  /// `outside_nan`: NaN where the point lies outside the solid. Throws Error naming the place where
  /// fractions cannot be normalised.
  void fractions_at(const double* points, size_t n, double* out, bool outside_nan = false) const;

 private:
  void lower_attributes();
  CheckedPlace checked_place() const;
  Lowering lowering_of(const Attribute& attribute) const;

  SceneDescription description_;
  Field solid_field_;
  std::vector<NamedField> fields_;
  BoundingBox bounds_;
  Expression drawn_, removed_;
  std::vector<Expression> fractions_;
  std::vector<Warning> unproven_;  // what the checks of the constructor left open
  Evaluator fraction_evaluator_;   // the fractions, then the solid
};

}  // namespace sardf
