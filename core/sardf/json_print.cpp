#include <nlohmann/json.hpp>

#include "sardf/json_document.hpp"
#include "sardf/number_text.hpp"

namespace sardf {

namespace {

using Type = JsonValue::Type;

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print(const JsonValue& value, std::string& to);

void print_list(const JsonValue& value, std::string& to) {
  to += '[';
  for (size_t i = 0; i < value.elements.size(); ++i) {
    if (i) to += ", ";
    print(value.elements[i], to);
  }
  to += ']';
}

void print_object(const JsonValue& value, std::string& to) {
  to += '{';
  for (size_t i = 0; i < value.members.size(); ++i) {
    if (i) to += ", ";
    to += quoted(value.members[i].key) + ": ";
    print(value.members[i].value, to);
  }
  to += '}';
}

void print(const JsonValue& value, std::string& to) {
  switch (value.type) {
    case Type::null:
      to += "null";
      break;
    case Type::boolean:
      to += value.truth ? "true" : "false";
      break;
    case Type::number:
      to += number_text(value.number);
      break;
    case Type::string:
      to += quoted(value.text);
      break;
    case Type::array:
      print_list(value, to);
      break;
    case Type::object:
      print_object(value, to);
      break;
  }
}

bool are_numbers(const std::vector<JsonValue>& elements) {
  for (const JsonValue& element : elements) {
    if (!element.is(Type::number)) return false;
  }
  return !elements.empty();
}

// As many on each line as it has room for.
void print_number_lines(const JsonValue& value, size_t indent, size_t width, std::string& to) {
  std::string line(indent + 2, ' ');
  to += "[\n";
  for (size_t i = 0; i < value.elements.size(); ++i) {
    const std::string text =
        number_text(value.elements[i].number) + (i + 1 < value.elements.size() ? "," : "");
    if (line.size() > indent + 2) {
      if (line.size() + 1 + text.size() <= width) {
        line += ' ';
      } else {
        to += line + '\n';
        line.assign(indent + 2, ' ');
      }
    }
    line += text;
  }
  to += line + '\n' + std::string(indent, ' ') + ']';
}

// `used`: characters that stand before the value on its line, and after it.
void print_lines(const JsonValue& value, size_t indent, size_t used, size_t width,
                 std::string& to) {
  std::string line;
  print(value, line);
  const bool is_object = value.is(Type::object);
  const size_t n = is_object ? value.members.size() : value.elements.size();
  if (used + line.size() <= width || n == 0) {
    to += line;
    return;
  }
  if (are_numbers(value.elements)) return print_number_lines(value, indent, width, to);
  const std::string inner(indent + 2, ' ');
  to += is_object ? "{\n" : "[\n";
  for (size_t i = 0; i < n; ++i) {
    const std::string key = is_object ? quoted(value.members[i].key) + ": " : "";
    to += inner + key;
    print_lines(is_object ? value.members[i].value : value.elements[i], indent + 2,
                inner.size() + key.size() + 1, width, to);
    to += i + 1 < n ? ",\n" : "\n";
  }
  to += std::string(indent, ' ') + (is_object ? "}" : "]");
}

}  // namespace

JsonValue JsonValue::of(double number) {
  JsonValue value;
  value.type = Type::number;
  value.number = number;
  return value;
}

JsonValue JsonValue::of(bool truth) {
  JsonValue value;
  value.type = Type::boolean;
  value.truth = truth;
  return value;
}

JsonValue JsonValue::of(std::string text) {
  JsonValue value;
  value.type = Type::string;
  value.text = std::move(text);
  return value;
}

JsonValue JsonValue::list() {
  JsonValue value;
  value.type = Type::array;
  return value;
}

JsonValue JsonValue::object() {
  JsonValue value;
  value.type = Type::object;
  return value;
}

void JsonValue::add(const std::string& key, JsonValue value) {
  members.push_back({key, 0, std::move(value)});
}

void JsonValue::add(JsonValue value) { elements.push_back(std::move(value)); }

std::string json_text(const JsonValue& value) {
  std::string text;
  print(value, text);
  return text;
}

std::string pretty_json(const JsonValue& value, size_t width) {
  std::string text;
  print_lines(value, 0, 0, width, text);
  return text + "\n";
}

}  // namespace sardf
