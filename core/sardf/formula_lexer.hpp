// Words of the formula language.
#pragma once

#include <string>
#include <vector>

namespace sardf {

struct FormulaToken {
  enum class Type { number, name, symbol, end, invalid };
  Type type = Type::end;
  std::string text;  // as it stands; of a symbol one of + - * / ^ < <= > >= == != ( ) ,
  double value = 0;
  size_t begin = 0;  // byte offset
};

/// All words in order, then one of type end; stops after the first of type invalid.
std::vector<FormulaToken> formula_tokens(const std::string& text);

/// "at character N" for a byte offset; a character may have several bytes (UTF-8).
std::string at_character(const std::string& text, size_t offset);

}  // namespace sardf
