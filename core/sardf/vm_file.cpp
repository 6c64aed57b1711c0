#include "sardf/vm_file.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unordered_map>
#include <vector>

#include "sardf/arithmetic.hpp"
#include "sardf/error.hpp"

namespace sardf {

namespace {

using Operands = std::vector<Expression>;

struct Word {
  const char* name;
  size_t operands;
  Expression (*make)(const Operands& of);
};

const std::vector<Word>& words() {
  static const std::vector<Word> all{
      {"var-x", 0, [](const Operands&) { return coordinate(0); }},
      {"var-y", 0, [](const Operands&) { return coordinate(1); }},
      {"var-z", 0, [](const Operands&) { return coordinate(2); }},
      {"neg", 1, [](const Operands& of) { return -of[0]; }},
      {"abs", 1, [](const Operands& of) { return abs(of[0]); }},
      {"square", 1, [](const Operands& of) { return of[0] * of[0]; }},
      {"sqrt", 1, [](const Operands& of) { return function("sqrt", {of[0]}); }},
      {"recip", 1, [](const Operands& of) { return constant(1) / of[0]; }},
      {"exp", 1, [](const Operands& of) { return exp(of[0]); }},
      {"ln", 1, [](const Operands& of) { return log(of[0]); }},
      {"sin", 1, [](const Operands& of) { return function("sin", {of[0]}); }},
      {"cos", 1, [](const Operands& of) { return function("cos", {of[0]}); }},
      {"tan", 1, [](const Operands& of) { return function("tan", {of[0]}); }},
      {"asin", 1, [](const Operands& of) { return function("asin", {of[0]}); }},
      {"acos", 1, [](const Operands& of) { return function("acos", {of[0]}); }},
      {"atan", 1,
       [](const Operands& of) {
         return function("atan2", {of[0], constant(1)});
       }},
      {"floor", 1, [](const Operands& of) { return function("floor", {of[0]}); }},
      {"ceil", 1, [](const Operands& of) { return -function("floor", {-of[0]}); }},
      {"add", 2, [](const Operands& of) { return of[0] + of[1]; }},
      {"sub", 2, [](const Operands& of) { return of[0] - of[1]; }},
      {"mul", 2, [](const Operands& of) { return of[0] * of[1]; }},
      {"div", 2, [](const Operands& of) { return of[0] / of[1]; }},
      {"min", 2, [](const Operands& of) { return min(of[0], of[1]); }},
      {"max", 2, [](const Operands& of) { return max(of[0], of[1]); }},
      {"mod", 2,
       [](const Operands& of) {
         return function("mod", {of[0], of[1]});
       }},
      {"atan2", 2,
       [](const Operands& of) {
         return function("atan2", {of[0], of[1]});
       }},
  };
  return all;
}

class Parser {
 public:
  explicit Parser(const std::string& file) : file_(file) {}

  void read_line(const std::string& line) {
    ++line_;
    std::istringstream blanks(line.substr(0, line.find('#')));
    std::vector<std::string> parts;
    for (std::string part; blanks >> part;) parts.push_back(part);
    if (parts.empty()) return;
    if (parts.size() < 2)
      fail("found '" + parts[0] + "' alone; a name and an operation are accepted");
    result_ = parts[1] == "const" ? number(parts) : call_of_word(parts);
    if (!known_.emplace(parts[0], result_).second) fail("'" + parts[0] + "' is given twice");
  }

  Expression result() const {
    if (!result_) throw Error("there is no expression", file_);
    return -result_;
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { throw Error(text, file_, line_); }

  Expression number(const std::vector<std::string>& parts) const {
    if (parts.size() != 3) fail("const has " + count(parts) + " operands; one number is accepted");
    double value = 0;
    const char *begin = parts[2].data(), *end = begin + parts[2].size();
    const auto [next, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || next != end || !std::isfinite(value)) {
      fail("found '" + parts[2] + "'; a finite number is accepted");
    }
    return constant(value);
  }

  Expression call_of_word(const std::vector<std::string>& parts) const {
    for (const Word& word : words()) {
      if (parts[1] != word.name) continue;
      if (parts.size() - 2 != word.operands) {
        fail(parts[1] + " has " + count(parts) + " operands; " + std::to_string(word.operands) +
             (word.operands == 1 ? " is accepted" : " are accepted"));
      }
      Operands of;
      for (size_t k = 2; k < parts.size(); ++k) of.push_back(named(parts[k]));
      return word.make(of);
    }
    std::vector<std::string> accepted{"const"};
    std::string list = "const";
    for (const Word& word : words()) {
      accepted.push_back(word.name);
      list += ", " + accepted.back();
    }
    fail("there is no operation '" + parts[1] + "'; accepted are " + list +
         did_you_mean(parts[1], accepted));
  }

  Expression named(const std::string& name) const {
    const auto found = known_.find(name);
    if (found == known_.end()) fail("'" + name + "' is not given before this line");
    return found->second;
  }

  static std::string count(const std::vector<std::string>& parts) {
    return std::to_string(parts.size() - 2);
  }

  const std::string& file_;
  int line_ = 0;
  Expression result_;
  std::unordered_map<std::string, Expression> known_;
};

Expression parse(std::istream& text, const std::string& file) {
  Parser parser(file);
  for (std::string line; std::getline(text, line);) parser.read_line(line);
  return parser.result();
}

}  // namespace

Expression parse_vm(const std::string& text, const std::string& file) {
  std::istringstream stream(text);
  return parse(stream, file);
}

Expression read_vm(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw Error("is a folder", path);
  std::ifstream file(path);
  if (!file) throw Error("cannot be read: " + std::string(std::strerror(errno)), path);
  return parse(file, path);
}

}  // namespace sardf
