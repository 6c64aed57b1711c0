#include "sardf/scene_file_values.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sardf/formula.hpp"
#include "sardf/short_number.hpp"

namespace sardf {

namespace {

using Type = JsonValue::Type;

std::string found(const JsonValue& value) {
  switch (value.type) {
    case Type::string:
      return "the string \"" +
             (value.text.size() > 40 ? value.text.substr(0, 40) + "..." : value.text) + "\"";
    case Type::number:
      return "the number " + short_number(value.number, 6);
    case Type::array:
      return "a list of " + std::to_string(value.elements.size());
    default:
      return json_type_name(value);
  }
}

// IEC 61966-2-1.
double linear_from_srgb(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::optional<Vec3> color_from_hex(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
    return std::nullopt;
  }
  Vec3 color;
  for (size_t c = 0; c < 3; ++c) {
    color[c] = linear_from_srgb(std::stoi(text.substr(1 + 2 * c, 2), nullptr, 16) / 255.0);
  }
  return color;
}

constexpr const char* accepted_number = "a number or a formula \"=...\"";

}  // namespace

std::string hex_color(const Vec3& linear) {
  std::string text = "#";
  for (const double c : linear) {
    int level = 0;
    while (level < 255 && linear_from_srgb(level / 255.0) < c) ++level;
    if (linear_from_srgb(level / 255.0) != c) return "";
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned>(level) & 255u);
    text += digits;
  }
  return text;
}

std::optional<JsonPlace> JsonPlace::find(const std::string& key) const {
  const JsonValue* found_value = value->find(key);
  if (!found_value) return std::nullopt;
  return JsonPlace{found_value, pointer_to(pointer, key)};
}

void ValueReader::error(const JsonPlace& place, const std::string& message) {
  errors.emplace_back(message, file_, place.value->line, place.pointer);
}

void ValueReader::error_at_key(const JsonPlace& object, const JsonMember& member,
                               const std::string& message) {
  errors.emplace_back(message, file_, member.line, pointer_to(object.pointer, member.key));
}

void ValueReader::wrong_type(const JsonPlace& place, const std::string& accepted) {
  error(place, "found " + found(*place.value) + "; " + accepted + " is accepted");
}

std::optional<std::string> ValueReader::text(const JsonPlace& place) {
  if (place.value->is(Type::string)) return place.value->text;
  wrong_type(place, "a string");
  return std::nullopt;
}

std::optional<bool> ValueReader::boolean(const JsonPlace& place) {
  if (place.value->is(Type::boolean)) return place.value->truth;
  wrong_type(place, "true or false");
  return std::nullopt;
}

std::optional<double> ValueReader::any_number(const JsonPlace& place) {
  const JsonValue& value = *place.value;
  if (value.is(Type::number)) return value.number;
  if (value.is(Type::string) && value.text.starts_with("=")) {
    return guarded(place, [&] { return parse_number(value.text.substr(1), parameters); });
  }
  wrong_type(place, accepted_number);
  return std::nullopt;
}

std::optional<double> ValueReader::number(const JsonPlace& place, const std::string& name,
                                          Range range) {
  const std::optional<double> value = any_number(place);
  ParameterInfo info;
  info.name = name;
  info.range = range;
  const auto check = [&] {
    check_argument(info, *value);
    return true;
  };
  return value && guarded(place, check) ? value : std::nullopt;
}

template <size_t N>
std::optional<std::array<double, N>> ValueReader::numbers(const JsonPlace& place,
                                                          const std::string& accepted) {
  const JsonValue& value = *place.value;
  if (!value.is(Type::array) || value.elements.size() != N) {
    wrong_type(place, accepted);
    return std::nullopt;
  }
  std::array<double, N> out{};
  bool good = true;
  for (size_t i = 0; i < N; ++i) {
    const auto a = any_number(place.element(i));
    good = good && a;
    out[i] = a.value_or(0);
  }
  return good ? std::optional(out) : std::nullopt;
}

// Of two numbers: in the plane z = 0.
std::optional<Vec3> ValueReader::point(const JsonPlace& place) {
  const std::string accepted = "2 or 3 numbers";
  if (!place.value->is(Type::array) || place.value->elements.size() != 2) {
    return numbers<3>(place, accepted);
  }
  const auto flat = numbers<2>(place, accepted);
  return flat ? std::optional(Vec3{(*flat)[0], (*flat)[1], 0}) : std::nullopt;
}

template <class Read>
auto ValueReader::points(const JsonPlace& place, const ParameterInfo& info, const Read& read)
    -> std::optional<std::vector<typename decltype(read(place))::value_type>> {
  if (!list(place, type_name(info.type))) return std::nullopt;
  std::vector<typename decltype(read(place))::value_type> out;
  bool good = true;
  for (size_t i = 0; i < place.value->elements.size(); ++i) {
    const auto point = read(place.element(i));
    good = good && point;
    if (point) out.push_back(*point);
  }
  return good ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<std::vector<double>> ValueReader::number_list(const JsonPlace& place,
                                                            const ParameterInfo& info) {
  if (!list(place, type_name(info.type))) return std::nullopt;
  std::vector<double> out;
  bool good = true;
  for (size_t i = 0; i < place.value->elements.size(); ++i) {
    const auto a = any_number(place.element(i));
    good = good && a;
    out.push_back(a.value_or(0));
  }
  return good ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<PointGrid> ValueReader::point_grid(const JsonPlace& place,
                                                 const ParameterInfo& info) {
  if (!list(place, type_name(info.type))) return std::nullopt;
  PointGrid out;
  bool good = true;
  for (size_t i = 0; i < place.value->elements.size(); ++i) {
    auto row = points(place.element(i), info,
                      [&](const JsonPlace& point) { return numbers<3>(point, "3 numbers"); });
    good = good && row;
    out.push_back(std::move(row).value_or(std::vector<Vec3>{}));
  }
  return good ? std::optional(std::move(out)) : std::nullopt;
}

FilePath ValueReader::file_path(const std::string& name) const {
  return {name, std::filesystem::path(file_).parent_path()};
}

std::optional<Vec3> ValueReader::vector3(const JsonPlace& place, const std::string& name) {
  ParameterInfo info;
  info.name = name;
  info.type = ParameterType::vector3;
  const auto value = argument(place, info);
  return value ? std::optional(std::get<Vec3>(*value)) : std::nullopt;
}

std::optional<Vec3> ValueReader::direction(const JsonPlace& place, const std::string& name) {
  ParameterInfo info;
  info.name = name;
  info.type = ParameterType::axis;
  const auto value = argument(place, info);
  return value ? std::optional(std::get<Vec3>(*value)) : std::nullopt;
}

std::optional<Vec3> ValueReader::color(const JsonPlace& place, double largest) {
  const std::string accepted = "\"#rrggbb\" (sRGB) or 3 linear numbers";
  if (place.value->is(Type::string)) {
    const auto color = color_from_hex(place.value->text);
    if (!color) wrong_type(place, accepted);
    return color;
  }
  const auto color = numbers<3>(place, accepted);
  if (!color) return std::nullopt;
  for (const double c : *color) {
    if (c >= 0 && c <= largest) continue;
    error(place, "a component is " + short_number(c, 6) + "; 0 to " + short_number(largest, 6) +
                     " is accepted");
    return std::nullopt;
  }
  return color;
}

bool ValueReader::object(const JsonPlace& place, const std::string& accepted) {
  if (place.value->is(Type::object)) return true;
  wrong_type(place, accepted);
  return false;
}

bool ValueReader::list(const JsonPlace& place, const std::string& accepted) {
  if (place.value->is(Type::array)) return true;
  wrong_type(place, accepted);
  return false;
}

void ValueReader::check_keys(const JsonPlace& object, const std::vector<std::string>& accepted) {
  for (const JsonMember& member : object.value->members) {
    if (std::find(accepted.begin(), accepted.end(), member.key) != accepted.end()) continue;
    std::string message = "unknown key '" + member.key + "'" + did_you_mean(member.key, accepted);
    if (accepted.empty()) {
      message += "; no key is accepted here";
    } else if (message.back() != '?') {
      message += "; accepted are";
      for (const std::string& key : accepted) message += (&key == &accepted[0] ? " " : ", ") + key;
    }
    error_at_key(object, member, message);
  }
}

std::optional<std::vector<Field>> ValueReader::fields(const JsonPlace& place,
                                                      const ParameterInfo& info) {
  if (!list(place, type_name(info.type))) return std::nullopt;
  std::vector<Field> out;
  bool good = true;
  for (size_t i = 0; i < place.value->elements.size(); ++i) {
    const JsonPlace element = place.element(i);
    out.push_back(info.type == ParameterType::values ? field_or_number(element) : field(element));
    good = good && out.back();
  }
  return good ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<PlaneSection> ValueReader::section(const JsonPlace& place) {
  const size_t before = errors.size();
  if (!object(place, "an object such as {\"field\": \"contour\", \"z\": 2}")) return std::nullopt;
  check_keys(place, {"field", "z"});
  PlaneSection read;
  if (const auto at = place.find("field")) {
    read.field = field(*at);
  } else {
    error(place, "a section needs 'field': a field of x and y");
  }
  if (const auto at = place.find("z")) {
    read.z = number(*at, "z").value_or(0);
  } else {
    error(place, "a section needs 'z': its height");
  }
  return errors.size() == before && read.field ? std::optional(read) : std::nullopt;
}

std::optional<std::vector<PlaneSection>> ValueReader::sections(const JsonPlace& place,
                                                               const ParameterInfo& info) {
  if (!list(place, type_name(info.type))) return std::nullopt;
  std::vector<PlaneSection> out;
  bool good = true;
  for (size_t i = 0; i < place.value->elements.size(); ++i) {
    const auto read = section(place.element(i));
    good = good && read;
    out.push_back(read.value_or(PlaneSection{}));
  }
  return good ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<Value> ValueReader::argument(const JsonPlace& place, const ParameterInfo& info) {
  const JsonValue& value = *place.value;
  std::optional<Value> read;
  switch (info.type) {
    case ParameterType::boolean:
      read = as_value(boolean(place));
      break;
    case ParameterType::number:
    case ParameterType::optional_number:
      read = as_value(any_number(place));
      break;
    case ParameterType::text:
      read = as_value(text(place));
      break;
    case ParameterType::vector2:
      read = as_value(numbers<2>(place, type_name(info.type)));
      break;
    case ParameterType::vector3:
    case ParameterType::optional_vector3:
      read = as_value(numbers<3>(place, type_name(info.type)));
      break;
    case ParameterType::optional_vector4:
      read = as_value(numbers<4>(place, type_name(info.type)));
      break;
    case ParameterType::axis:
      if (value.is(Type::string) && value.text.size() == 1 && 'x' <= value.text[0] &&
          value.text[0] <= 'z') {
        Vec3 unit{};
        unit[size_t(value.text[0] - 'x')] = 1;
        return unit;
      }
      read = as_value(numbers<3>(place, type_name(info.type)));
      break;
    case ParameterType::numbers:
      read = as_value(number_list(place, info));
      break;
    case ParameterType::point_grid:
      read = as_value(point_grid(place, info));
      break;
    case ParameterType::rule:
      if (RulePointer rule = value_rule(place)) read = std::move(rule);
      break;
    case ParameterType::path:
      if (const auto name = text(place)) read = file_path(*name);
      break;
    case ParameterType::points2:
      read = as_value(
          points(place, info, [&](const JsonPlace& at) { return numbers<2>(at, "2 numbers"); }));
      break;
    case ParameterType::points3:
      read = as_value(points(place, info, [&](const JsonPlace& at) { return point(at); }));
      break;
    case ParameterType::field:
    case ParameterType::optional_field: {
      const Field one = field_or_number(place);
      if (one) read = one;
      break;
    }
    case ParameterType::fields:
    case ParameterType::values:
      read = as_value(fields(place, info));
      break;
    case ParameterType::sections:
      read = as_value(sections(place, info));
      break;
    case ParameterType::blend:
      read = as_value(blend(place));
      break;
  }
  const auto check = [&] {
    check_argument(info, *read);
    return true;
  };
  return read && guarded(place, check) ? read : std::nullopt;
}

std::optional<std::vector<Value>> ValueReader::arguments(const JsonPlace& place,
                                                         const std::string& owner,
                                                         const std::vector<ParameterInfo>& infos) {
  if (!object(place, "an object of the parameters of '" + owner + "'")) return std::nullopt;
  std::vector<std::string> names;
  for (const ParameterInfo& info : infos) names.push_back(info.name);
  const size_t before = errors.size();
  check_keys(place, names);
  bool good = errors.size() == before;
  std::vector<Value> out;
  for (const ParameterInfo& info : infos) {
    const auto given = place.find(info.name);
    const bool optional_null =
        given && given->value->is(Type::null) && !info.required && info.default_value.index() == 0;
    if (!given || optional_null) {
      if (info.required) {
        error(place, "'" + owner + "' needs '" + info.name + "': " + info.doc);
        good = false;
      }
      out.push_back(info.default_value);
      continue;
    }
    const auto read = argument(*given, info);
    good = good && read;
    out.push_back(read.value_or(Value()));
  }
  return good ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<BlendPointer> ValueReader::blend(const JsonPlace& place) {
  const JsonValue& value = *place.value;
  const bool named = value.is(Type::string);
  if (!named && !(value.is(Type::object) && value.members.size() == 1)) {
    wrong_type(place, "a blend's name, or an object such as {\"sardf\": 0.5}");
    return std::nullopt;
  }
  const std::string& name = named ? value.text : value.members[0].key;
  const BlendType* type = find_blend_type(name);
  if (!type) {
    std::vector<std::string> names;
    for (const BlendType& known : blend_types()) names.push_back(known.name);
    error(place, "there is no blend '" + name + "'" + did_you_mean(name, names));
    return std::nullopt;
  }
  const JsonValue empty{Type::object, false, 0, "", {}, {}, value.line};
  std::optional<std::vector<Value>> given;
  if (named) {
    given = arguments({&empty, place.pointer}, name, type->parameters);
  } else if (const JsonPlace inside = place.member(value.members[0]);
             inside.value->is(Type::object) || type->parameters.size() != 1) {
    given = arguments(inside, name, type->parameters);
  } else if (const auto read = argument(inside, type->parameters[0])) {
    given = std::vector<Value>{*read};
  }
  if (!given) return std::nullopt;
  return guarded(place, [&] { return make_blend(name, *given); });
}

}  // namespace sardf
