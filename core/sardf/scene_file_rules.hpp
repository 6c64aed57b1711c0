// Reads fraction rules, and the same rules for attributes.
#pragma once

#include "sardf/fractions.hpp"
#include "sardf/scene_file_fields.hpp"

namespace sardf {

/// What the parts of a value have in common: how many components, 0 while that is not known yet,
/// and their names if they have any.
struct ValueShape {
  size_t components = 0;
  std::vector<std::string> names;
};

class RuleReader : public FieldReader {
 public:
  using FieldReader::FieldReader;

  std::vector<std::string> materials;

  /// A material's name or {rule: ...}; empty where it is wrong.
  Fractions fractions(const JsonPlace& place);
  /// A field, a number, a list of these, or {rule: ...}, of a shape that the first part decides.
  Fractions value(const JsonPlace& place, ValueShape& shape);

 protected:
  RulePointer value_rule(const JsonPlace& place) override;
  /// Called for each rule that was read, with the place of its value.
  virtual void rule_was_read(const RulePointer&, const JsonPlace&) {}

 private:
  // What a rule is read for: shape is nullptr where it gives fractions.
  struct Wanted {
    ValueShape* shape;
    RuleUse other() const { return shape ? RuleUse::fractions : RuleUse::values; }
  };

  Fractions nested(const JsonPlace& place, Wanted wanted);
  Fractions rule(const JsonPlace& place, Wanted wanted);
  const RuleType* known_rule(const JsonPlace& place, const JsonMember& member, Wanted wanted);
  Fractions constant_value(const JsonPlace& place, ValueShape& shape);
  std::optional<std::vector<RuleValue>> rule_values(const JsonPlace& place,
                                                    const std::string& owner,
                                                    const std::vector<RuleParameter>& infos,
                                                    Wanted wanted);
  RuleValue rule_value(const JsonPlace& place, const RuleParameter& parameter, Wanted wanted,
                       const Field& feature);
  RuleValue records(const JsonPlace& place, const RuleParameter& parameter, Wanted wanted);
  RuleValue whole_value(const JsonPlace& place, RuleParameterType type);
  RuleValue named_values(const JsonPlace& place, ValueShape& shape);
  bool check_material(const std::string& name, const JsonPlace* place, const JsonPlace* object,
                      const JsonMember* member);

  bool for_field_ = false;  // a rule inside a field, which knows no scene's fractions
};

/// The keys that a parameter may have in a file: "fractions" may be "material", or "value".
std::vector<std::string> keys_of(const RuleParameter& parameter, bool of_values);

}  // namespace sardf
