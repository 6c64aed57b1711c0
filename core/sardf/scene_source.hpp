// Where the parts of a scene stand in the file that it was read from.
#pragma once

#include <map>
#include <string>

#include "sardf/error.hpp"
#include "sardf/field.hpp"
#include "sardf/json_document.hpp"

namespace sardf {

/// Empty for a scene that was read from no text.
struct SceneSource {
  std::string file;
  std::map<std::string, int> lines;  // of the main parts, by JSON pointer
  /// The JSON pointers of the rules' values. It keeps the rules, so that no other gets the address
  /// of one that is gone.
  std::map<RulePointer, std::string> rules;

  /// The error at a JSON pointer; at the file alone where no line of it is known.
  Error error(const std::string& message, const std::string& pointer) const {
    const auto line = lines.find(pointer);
    if (line == lines.end()) return Error(message, file);
    return Error(message, file, line->second, pointer);
  }
  /// The error at a member of a rule's value, or at the whole value for "". Without any place where
  /// the rule's is not known.
  Error error_in(const RulePointer& rule, const std::string& member,
                 const std::string& message) const {
    const auto place = rules.find(rule);
    if (place == rules.end()) return Error(message);
    return error(message, member.empty() ? place->second : pointer_to(place->second, member));
  }
};

}  // namespace sardf
