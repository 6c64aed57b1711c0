// Reads the fields of a scene file: constructors, formulas, and names in any order.
#pragma once

#include <set>

#include "sardf/scene.hpp"
#include "sardf/scene_file_values.hpp"

namespace sardf {

class FieldReader : public ValueReader {
 public:
  /// `given`: names that the file may use besides its own.
  FieldReader(std::string file, const std::map<std::string, Field>& given)
      : ValueReader(std::move(file)), known_(given), given_(given) {}

  /// Defines the members of an object as named fields; they may name each other in any order, but
  /// not in a circle.
  void define(const JsonPlace& object);
  /// The named fields in the order of the file, then those used of the given ones.
  std::vector<NamedField> named() const;

  /// A name, "=formula", or {constructor: parameters}; null where it is wrong.
  Field field(const JsonPlace& place) override;
  /// The same, or a number.
  Field field_or_number(const JsonPlace& place) override;
  /// The same where formulas may also use `name` for `meaning`.
  Field field_with(const JsonPlace& place, const std::string& name, const Field& meaning);

 private:
  struct Definition {
    const JsonMember* member;
    JsonPlace place;
  };

  std::vector<size_t> references(const JsonValue& value) const;
  std::vector<size_t> in_order_of_use(const JsonPlace& object);
  void report_circle(const JsonPlace& object, const std::vector<size_t>& circle);
  /// `otherwise`: what messages say is accepted too.
  Field field_like(const JsonPlace& place, const std::string& otherwise);
  Field formula(const JsonPlace& place);
  Field by_name(const JsonPlace& place);
  Field constructed_field(const JsonPlace& place);
  Field construct(const JsonPlace& parameters_at, const Constructor& constructor);

  std::map<std::string, Field> known_;
  std::map<std::string, Field> given_;
  std::set<std::string> used_given_;
  std::set<std::string> failed_;  // defined, but wrong: reported once, where they are defined
  std::vector<Definition> definitions_;
  std::map<std::string, size_t> definition_of_;
};

}  // namespace sardf
