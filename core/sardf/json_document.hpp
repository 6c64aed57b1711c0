// JSON text as a tree that knows the line of every value. Comments are allowed.
#pragma once

#include <string>
#include <vector>

#include "sardf/error.hpp"

namespace sardf {

struct JsonMember;

struct JsonValue {
  enum class Type { null, boolean, number, string, array, object };
  Type type = Type::null;
  bool truth = false;
  double number = 0;
  std::string text;
  std::vector<JsonValue> elements;
  std::vector<JsonMember> members;  // in the order of the text
  int line = 0;                     // where the value starts

  static JsonValue of(double number);
  static JsonValue of(bool truth);
  static JsonValue of(std::string text);
  static JsonValue list();
  static JsonValue object();
  /// Adds to an object, or to a list.
  void add(const std::string& key, JsonValue value);
  void add(JsonValue value);

  bool is(Type t) const { return type == t; }
  /// nullptr when there is none.
  const JsonValue* find(const std::string& key) const;
};

struct JsonMember {
  std::string key;
  int line = 0;  // of the key
  JsonValue value;
};

/// "a number", "an object", ...
std::string json_type_name(const JsonValue& value);

/// The value as JSON text on one line. Numbers have as many digits as they need.
std::string json_text(const JsonValue& value);
/// The value as JSON text on lines of up to `width` characters where that is possible.
std::string pretty_json(const JsonValue& value, size_t width = 100);

/// A JSON pointer with one more step; `key` is escaped.
std::string pointer_to(const std::string& pointer, const std::string& key);
std::string pointer_to(const std::string& pointer, size_t index);

/// How deep values may be nested.
inline constexpr size_t deepest_json = 256;

/// Parses a text. Keys that stand twice in an object are reported in `problems`, and the first one
/// counts. Throws Error with file and line when it is not JSON, or nested too deep.
JsonValue parse_json(const std::string& text, const std::string& file,
                     std::vector<Error>& problems);

}  // namespace sardf
