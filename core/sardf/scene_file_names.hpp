// Which fields of a scene get a name when it is written.
#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "sardf/scene.hpp"

namespace sardf {

/// Fields keep the names they have. Names are given to fields that are used more than once, that
/// formulas name, and that would stand too deep inside others.
class FieldNames {
 public:
  /// The scene must outlive it. Throws Error for a field that no constructor or formula made.
  explicit FieldNames(const SceneDescription& scene);

  /// All that must be defined, the scene's own first.
  const std::vector<NamedField>& defined() const { return defined_; }
  /// All that fields are made by, parts before what is made of them.
  const std::vector<const Construction*>& constructions() const { return order_; }
  /// "" for a field without a name.
  std::string name_of(const Field& field) const { return name_of(field.construction()); }
  std::string name_of(const Construction* made) const;
  /// A formula's text with the names that its fields have here.
  std::string formula_text(const Construction& formula) const;

 private:
  struct Use {
    size_t count = 0;
    bool by_formula = false;
    std::string wanted;  // the name a formula has for it
    Field field;
  };

  void collect(const std::vector<Field>& roots);
  void give_names();
  std::string fresh(const std::string& wanted);

  std::map<std::string, double> parameters_;
  std::unordered_map<const Construction*, Use> uses_;
  std::vector<const Construction*> order_;
  std::unordered_map<const Construction*, std::string> names_;
  std::map<std::string, size_t> numbers_;  // last number given to each stem
  std::set<std::string> taken_;
  std::vector<NamedField> defined_;
};

}  // namespace sardf
