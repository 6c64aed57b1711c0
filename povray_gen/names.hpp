// Identifiers that POV-Ray accepts and that clash with nobody's.
#pragma once

#include <map>
#include <set>
#include <string>

namespace sardf::povray {

/// Gives out identifiers PREFIX_word: letters, digits and _ only, each once. POV-Ray's reserved
/// words are all without a prefix ending in _, so none of these is one; and a user's own
/// declarations cannot clash with ours. (A parameter of a function must not be declared elsewhere
/// either, so parameters carry the prefix too.)
class Names {
 public:
  /// `title`: any text, in any script; letters and digits of ASCII survive. "part" if none does.
  explicit Names(const std::string& title);

  const std::string& prefix() const { return prefix_; }
  /// PREFIX_word (the word itself if it begins with PREFIX_) where that is free, else
  /// PREFIX_word_2, _3, ...
  std::string unique(const std::string& word);
  /// PREFIX_word_1, PREFIX_word_2, ...: the first that is free.
  std::string numbered(const std::string& word);
  /// The name of the parameter `index` (from 0) of a function: PREFIX__a ... PREFIX__z, PREFIX__a1
  /// ... The same for every function, and different from what unique() and numbered() give out.
  std::string parameter(int index) const;

 private:
  std::string join(const std::string& word) const;

  std::string prefix_;
  std::set<std::string> taken_;
  std::map<std::string, int> numbers_;  // the last number given out after a word
};

/// The shortest text that reads back as the same double, with a decimal point in every locale.
/// Throws Error for infinities and NaN, which POV-Ray cannot read.
std::string number_text(double value);

/// A number that bounds others from above: three digits, rounded up.
std::string bound_text(double value);

}  // namespace sardf::povray
