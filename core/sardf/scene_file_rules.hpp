// Reads fraction rules, and the same rules for attributes.
#pragma once

#include "sardf/fractions.hpp"
#include "sardf/scene_file_fields.hpp"

namespace sardf {

class RuleReader : public FieldReader {
 public:
  using FieldReader::FieldReader;

  std::vector<std::string> materials;

  /// A material's name or {rule: ...}; empty where it is wrong.
  Fractions fractions(const JsonPlace& place);
  /// A field, a number, a list of these, or {rule: ...}. `components` is how many there must be,
  /// 0 while that is not known yet.
  Fractions value(const JsonPlace& place, size_t& components);

 protected:
  RulePointer value_rule(const JsonPlace& place) override;

 private:
  // What a rule is read for: components is nullptr where it gives fractions.
  struct Wanted {
    size_t* components;
    RuleUse other() const { return components ? RuleUse::fractions : RuleUse::values; }
  };

  Fractions nested(const JsonPlace& place, Wanted wanted);
  Fractions rule(const JsonPlace& place, Wanted wanted);
  Fractions constant_value(const JsonPlace& place, size_t& components);
  std::optional<std::vector<RuleValue>> rule_values(const JsonPlace& place,
                                                    const std::string& owner,
                                                    const std::vector<RuleParameter>& infos,
                                                    Wanted wanted);
  RuleValue rule_value(const JsonPlace& place, const RuleParameter& parameter, Wanted wanted,
                       const Field& feature);
  RuleValue records(const JsonPlace& place, const RuleParameter& parameter, Wanted wanted);
  RuleValue material_members(const JsonPlace& place, bool shares);
  bool check_material(const std::string& name, const JsonPlace* place, const JsonPlace* object,
                      const JsonMember* member);
};

/// The keys that a parameter may have in a file: "fractions" may be "material", or "value".
std::vector<std::string> keys_of(const RuleParameter& parameter, bool of_values);

}  // namespace sardf
