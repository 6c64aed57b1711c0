#include "sardf/formula_lexer.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string_view>

namespace sardf {

namespace {

bool is_digit(char c) { return '0' <= c && c <= '9'; }
bool starts_name(char c) { return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The bytes of the character that starts at `begin`.
size_t character_length(const std::string& text, size_t begin) {
  size_t end = begin + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return end - begin;
}

FormulaToken number_at(const std::string& text, size_t begin) {
  FormulaToken token{FormulaToken::Type::number, "", 0, begin};
  const char *first = text.data() + begin, *last = text.data() + text.size();
  const auto [end, problem] = std::from_chars(first, last, token.value);
  token.text.assign(first, end);
  // "2x" and "1.2.3" are slips, not products.
  const bool runs_on = end != last && (starts_name(*end) || is_digit(*end) || *end == '.');
  if (problem != std::errc() || runs_on) {
    const char* stop = end;
    while (stop != last && (starts_name(*stop) || is_digit(*stop) || *stop == '.')) ++stop;
    token.text.assign(first, std::max(stop, first + 1));
    token.type = FormulaToken::Type::invalid;
  }
  return token;
}

FormulaToken symbol_at(const std::string& text, size_t begin) {
  constexpr std::string_view symbols[] = {"<=", ">=", "==", "!=", "+", "-", "*",
                                          "/",  "^",  "<",  ">",  "(", ")", ","};
  for (const std::string_view symbol : symbols) {
    if (text.compare(begin, symbol.size(), symbol) == 0) {
      return {FormulaToken::Type::symbol, std::string(symbol), 0, begin};
    }
  }
  return {FormulaToken::Type::invalid, text.substr(begin, character_length(text, begin)), 0, begin};
}

}  // namespace

std::vector<FormulaToken> formula_tokens(const std::string& text) {
  std::vector<FormulaToken> tokens;
  size_t at = 0;
  while (true) {
    while (at < text.size() && is_space(text[at])) ++at;
    if (at == text.size()) break;
    const char c = text[at];
    const bool is_number =
        is_digit(c) || (c == '.' && at + 1 < text.size() && is_digit(text[at + 1]));
    if (is_number) {
      tokens.push_back(number_at(text, at));
    } else if (starts_name(c)) {
      size_t end = at;
      while (end < text.size() && (starts_name(text[end]) || is_digit(text[end]))) ++end;
      tokens.push_back({FormulaToken::Type::name, text.substr(at, end - at), 0, at});
    } else {
      tokens.push_back(symbol_at(text, at));
    }
    if (tokens.back().type == FormulaToken::Type::invalid) return tokens;
    at += tokens.back().text.size();
  }
  tokens.push_back({FormulaToken::Type::end, "", 0, text.size()});
  return tokens;
}

std::string at_character(const std::string& text, size_t offset) {
  const auto starts = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  const auto before = std::count_if(text.begin(), text.begin() + std::ptrdiff_t(offset), starts);
  return "at character " + std::to_string(before + 1);
}

}  // namespace sardf
