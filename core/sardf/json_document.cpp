#include "sardf/json_document.hpp"

#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

namespace sardf {

namespace {

// Counts lines as the parser takes characters. A newline counts when the character after it is
// taken: the parser reads one character too many to see where a number ends.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  struct Counter {
    int line = 1;
    bool pending = false;
  };

  CountingIterator(const char* at, Counter* counter) : at_(at), counter_(counter) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (counter_->pending) ++counter_->line;
    counter_->pending = *at_ == '\n';
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  Counter* counter_;
};

// What the parser calls for every value, in order.
class Builder {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  Builder(const std::string& file, const CountingIterator::Counter& counter,
          std::vector<Error>& problems)
      : file_(file), counter_(counter), problems_(problems) {}

  bool null() { return add(made(JsonValue::Type::null)); }
  bool boolean(bool truth) {
    JsonValue value = made(JsonValue::Type::boolean);
    value.truth = truth;
    return add(std::move(value));
  }
  bool number_integer(number_integer_t a) { return number(double(a)); }
  bool number_unsigned(number_unsigned_t a) { return number(double(a)); }
  bool number_float(number_float_t a, const string_t&) { return number(a); }
  bool string(string_t& text) {
    JsonValue value = made(JsonValue::Type::string);
    value.text = std::move(text);
    return add(std::move(value));
  }
  bool binary(binary_t&) { return false; }
  bool start_object(size_t) { return open(JsonValue::Type::object); }
  bool start_array(size_t) { return open(JsonValue::Type::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(string_t& name) {
    Level& level = levels_.back();
    level.key = std::move(name);
    level.key_line = counter_.line;
    level.keep = level.keys.insert(level.key).second;
    if (!level.keep) {
      problems_.push_back(Error("the key '" + level.key + "' stands twice", file_, counter_.line,
                                pointer_to(pointer(), level.key)));
    }
    return true;
  }

  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception& problem) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
    std::string text = problem.what();
    const size_t column = text.find("column ");
    if (column != std::string::npos) {
      text = text.substr(column);
    } else if (const size_t end = text.find("] "); end != std::string::npos) {
      text = text.substr(end + 2);
    }
    throw Error("this is not JSON: " + text, file_, counter_.line, "");
  }

  JsonValue root;

 private:
  struct Level {
    JsonValue value;
    std::string key;  // of an object: the member being read
    int key_line = 0;
    bool keep = true;
    std::set<std::string> keys;
  };

  JsonValue made(JsonValue::Type type) const {
    JsonValue value;
    value.type = type;
    value.line = counter_.line;
    return value;
  }

  bool number(double a) {
    JsonValue value = made(JsonValue::Type::number);
    value.number = a;
    return add(std::move(value));
  }

  bool open(JsonValue::Type type) {
    if (levels_.size() == deepest_json) {
      throw Error(
          "values are nested more than " + std::to_string(deepest_json) + " deep; name them", file_,
          counter_.line, "");
    }
    levels_.emplace_back();
    levels_.back().value = made(type);
    return true;
  }

  bool close() {
    JsonValue value = std::move(levels_.back().value);
    levels_.pop_back();
    return add(std::move(value));
  }

  bool add(JsonValue value) {
    if (levels_.empty()) {
      root = std::move(value);
      return true;
    }
    Level& level = levels_.back();
    if (level.value.is(JsonValue::Type::array)) {
      level.value.elements.push_back(std::move(value));
    } else if (level.keep) {
      level.value.members.push_back({level.key, level.key_line, std::move(value)});
    }
    return true;
  }

  std::string pointer() const {
    std::string text;
    for (size_t i = 0; i + 1 < levels_.size(); ++i) {
      const Level& level = levels_[i];
      text = level.value.is(JsonValue::Type::array) ? pointer_to(text, level.value.elements.size())
                                                    : pointer_to(text, level.key);
    }
    return text;
  }

  const std::string& file_;
  const CountingIterator::Counter& counter_;
  std::vector<Error>& problems_;
  std::vector<Level> levels_;
};

}  // namespace

const JsonValue* JsonValue::find(const std::string& key) const {
  for (const JsonMember& member : members) {
    if (member.key == key) return &member.value;
  }
  return nullptr;
}

std::string json_type_name(const JsonValue& value) {
  switch (value.type) {
    case JsonValue::Type::null:
      return "null";
    case JsonValue::Type::boolean:
      return value.truth ? "true" : "false";
    case JsonValue::Type::number:
      return "a number";
    case JsonValue::Type::string:
      return "a string";
    case JsonValue::Type::array:
      return "a list";
    default:
      return "an object";
  }
}

std::string pointer_to(const std::string& pointer, const std::string& key) {
  std::string text = pointer + "/";
  for (const char c : key) {
    if (c == '~') {
      text += "~0";
    } else if (c == '/') {
      text += "~1";
    } else {
      text += c;
    }
  }
  return text;
}

std::string pointer_to(const std::string& pointer, size_t index) {
  return pointer + "/" + std::to_string(index);
}

JsonValue parse_json(const std::string& text, const std::string& file,
                     std::vector<Error>& problems) {
  CountingIterator::Counter counter;
  Builder builder(file, counter, problems);
  const CountingIterator first(text.data(), &counter), last(text.data() + text.size(), &counter);
  nlohmann::json::sax_parse(first, last, &builder, nlohmann::json::input_format_t::json, true,
                            true);
  return std::move(builder.root);
}

}  // namespace sardf
