// Terms as the text of POV-Ray functions.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "povray_gen/let_plan.hpp"
#include "povray_gen/names.hpp"
#include "povray_gen/terms.hpp"

namespace sardf::povray {

/// What the inputs of a function are called.
enum class InputNames { coordinates, parameters };  // x, y, z; or as Names::parameter

/// Collects `#declare NAME = function(...) {...}` texts, each after those that it calls. Helper
/// functions of equal text are one.
class FunctionPrinter {
 public:
  explicit FunctionPrinter(Names& names) : names_(names) {}

  /// Declares `name` as the term `root`, a function of the terms 0 ... inputs - 1, which are the
  /// inputs, and the helpers it needs as name_1, name_2, ... Throws Error when POV-Ray could not
  /// evaluate it.
  void declare(const std::string& name, const Terms& terms, int root, int inputs,
               InputNames input_names);

  /// The term as text in x, y and z, the terms 0, 1 and 2, for a place where it is evaluated very
  /// often: what is as quick to compute again as to pass is not passed. A text that is too long to
  /// stand there is declared as `name`, and called. Its helpers are named as above.
  std::string quick(const std::string& name, const Terms& terms, int root);

  /// Adds text that declares what functions after it call.
  void insert(const std::string& text) { text_ += text; }

  /// Lines of comment that stand before the function of this name, declared later.
  void comment(const std::string& name, std::string lines) { comments_[name] = std::move(lines); }

  const std::string& text() const { return text_; }

 private:
  friend class FamilyPrinter;
  using Attempt = std::pair<const Terms*, LetPlan::Simple>;
  /// The first plan that is possible; the last attempt's Error if none is.
  std::pair<const Terms*, LetPlan> first_plan(std::span<const Attempt> attempts, int root);
  struct Call {
    std::string name;
    int depth = 0;  // of calls inside each other
  };
  /// The function with this signature and body; declared now unless there is one.
  Call helper(const std::string& base, const std::string& signature, const std::string& body,
              int depth);
  void add(const std::string& name, const std::string& signature, const std::string& body,
           int depth);

  Names& names_;
  std::string text_;
  std::map<std::string, std::string> known_;  // signature and body -> name
  std::map<std::string, int> depth_;
  std::map<std::string, std::string> comments_;
};

}  // namespace sardf::povray
