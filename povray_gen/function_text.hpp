// Expression graphs as readable POV-Ray functions in which nothing is evaluated twice.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "povray_gen/function_printer.hpp"
#include "povray_gen/sampled_function.hpp"
#include "sardf/graph.hpp"

namespace sardf::povray {

struct NamedExpression {
  std::string name;
  Expression expression;
  std::string comment = {};  ///< a sentence for the reader of the function; empty: none
};

/// The text as lines of comment.
std::string comment_lines(const std::string& text);

/// Declares one function of x, y, z for each named expression, positive inside as everywhere in
/// our code. An operation becomes a function of its inputs, one for equal parameters, unless it is
/// as short as a call of it would be; where a cheap bound shows that a costly input of a union or
/// difference does not count, the input is not evaluated. A function calls that of another named
/// expression where nothing inside that one is also needed outside of it; else it computes the
/// shared parts once. Sampled functions (sampling.hpp) read their density files.
class FunctionWriter {
 public:
  explicit FunctionWriter(Names& names) : names_(names), printer_(names) {}

  /// Returns the identifiers of the functions, in the order of `expressions`. Those that others
  /// need are declared first. Throws Error naming the expression that POV-Ray cannot evaluate.
  std::vector<std::string> declare(std::span<const NamedExpression> expressions);
  std::string declare(const NamedExpression& expression);
  /// The expression as text in x, y and z that POV-Ray evaluates as fast as it can: operations of a
  /// dozen steps stand there themselves. `name`: what helper functions are named after.
  std::string quick(const std::string& name, const Expression& expression);

  /// All declarations so far.
  const std::string& text() const { return printer_.text(); }

 private:
  using OperationKey = std::pair<std::string, std::vector<double>>;

  std::string declare_function(const std::string& name, const NamedExpression& named);
  int add_terms(Terms& terms, const Expression& root);
  int add_guarded_call(Terms& terms, const Node& node, std::span<const int> inputs, int costly,
                       const std::function<int(const Expression&)>& term_of);
  int add_call(Terms& terms, const Operation& operation, std::span<const int> inputs);
  std::string declare_operation(const Operation& operation);
  std::string declare_samples(const SampledFunction& sampled);

  Names& names_;
  FunctionPrinter printer_;
  bool is_quick_ = false;
  std::unordered_map<const Node*, std::string> named_;
  std::vector<Expression> kept_alive_;              // so that a named node's address stays its own
  std::map<OperationKey, std::string> operations_;  // the helper, or "" for an inlined operation
};

}  // namespace sardf::povray
