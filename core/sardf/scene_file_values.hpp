// Reads numbers, vectors, colours, blends and named parameters of a scene file; collects errors.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sardf/constructor.hpp"
#include "sardf/json_document.hpp"

namespace sardf {

/// "#rrggbb" for a linear colour that is one of these 16 million to the last bit, else "".
std::string hex_color(const Vec3& linear);

/// A value and where it stands.
struct JsonPlace {
  const JsonValue* value;
  std::string pointer;

  JsonPlace element(size_t i) const { return {&value->elements[i], pointer_to(pointer, i)}; }
  JsonPlace member(const JsonMember& m) const { return {&m.value, pointer_to(pointer, m.key)}; }
  /// nullopt when there is no such member.
  std::optional<JsonPlace> find(const std::string& key) const;
};

/// Whatever it reads is nullopt where it is wrong, and the reason is in `errors`.
class ValueReader {
 public:
  explicit ValueReader(std::string file) : file_(std::move(file)) {}
  virtual ~ValueReader() = default;

  std::vector<Error> errors;
  /// What formulas may use, filled as the file defines it.
  std::map<std::string, double> parameters;

  void error(const JsonPlace& place, const std::string& message);
  /// The same at a member's key.
  void error_at_key(const JsonPlace& object, const JsonMember& member, const std::string& message);
  /// "found ...; ... is accepted".
  void wrong_type(const JsonPlace& place, const std::string& accepted);

  std::optional<std::string> text(const JsonPlace& place);
  std::optional<bool> boolean(const JsonPlace& place);
  /// A number, or a formula of parameters; finite and in range. Errors name it `name`.
  std::optional<double> number(const JsonPlace& place, const std::string& name,
                               Range range = Range::any);
  std::optional<Vec3> vector3(const JsonPlace& place, const std::string& name);
  std::optional<Vec3> direction(const JsonPlace& place, const std::string& name);
  /// "#rrggbb" in sRGB, or three linear numbers >= 0; linear.
  std::optional<Vec3> color(const JsonPlace& place, double largest);
  std::optional<BlendPointer> blend(const JsonPlace& place);

  /// Whether it is an object; else an error.
  bool object(const JsonPlace& place, const std::string& accepted);
  bool list(const JsonPlace& place, const std::string& accepted);
  /// Reports members that are not accepted, with the nearest accepted name.
  void check_keys(const JsonPlace& object, const std::vector<std::string>& accepted);

  /// The arguments of a constructor or blend from an object of named parameters.
  std::optional<std::vector<Value>> arguments(const JsonPlace& place, const std::string& owner,
                                              const std::vector<ParameterInfo>& infos);

 protected:
  virtual Field field(const JsonPlace& place) = 0;
  virtual Field field_or_number(const JsonPlace& place) = 0;
  /// A rule that gives one number; null where it is wrong.
  virtual RulePointer value_rule(const JsonPlace& place) = 0;
  /// Runs f; an Error it throws is reported at the place.
  template <class F>
  auto guarded(const JsonPlace& place, F f) -> std::optional<decltype(f())> {
    try {
      return f();
    } catch (const Error& problem) {
      error(place, problem.message);
      return std::nullopt;
    }
  }
  std::optional<Value> argument(const JsonPlace& place, const ParameterInfo& info);

 private:
  std::optional<double> any_number(const JsonPlace& place);
  template <size_t N>
  std::optional<std::array<double, N>> numbers(const JsonPlace& place, const std::string& accepted);
  std::optional<Vec3> point(const JsonPlace& place);
  /// `read`: reads one point.
  template <class Read>
  auto points(const JsonPlace& place, const ParameterInfo& info, const Read& read)
      -> std::optional<std::vector<typename decltype(read(place))::value_type>>;
  template <class T>
  std::optional<Value> as_value(const std::optional<T>& read) {
    return read ? std::optional<Value>(*read) : std::nullopt;
  }
  std::optional<std::vector<double>> number_list(const JsonPlace& place, const ParameterInfo& info);
  std::optional<PointGrid> point_grid(const JsonPlace& place, const ParameterInfo& info);
  FilePath file_path(const std::string& text) const;
  std::optional<std::vector<Field>> fields(const JsonPlace& place, const ParameterInfo& info);
  std::optional<PlaneSection> section(const JsonPlace& place);
  std::optional<std::vector<PlaneSection>> sections(const JsonPlace& place,
                                                    const ParameterInfo& info);

  std::string file_;
};

}  // namespace sardf
