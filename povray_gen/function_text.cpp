#include "povray_gen/function_text.hpp"

#include <algorithm>
#include <numeric>

#include "povray_gen/guards.hpp"
#include "povray_gen/linear_terms.hpp"
#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

// A call of a helper is no shorter than this many operators.
constexpr int inlined_operations = 3;
// Where text is evaluated very often, passing inputs costs as much as this many.
constexpr int quick_operations = 12;
constexpr size_t comment_width = 95;

InputNames input_names(const OperationInfo& info) {
  const bool of_space =
      info.kind == Kind::solid || info.kind == Kind::plane || info.kind == Kind::feature;
  return of_space ? InputNames::coordinates : InputNames::parameters;
}

// Whether the formula has at most so many operators and calls.
bool is_short(const Trace& trace, int most) {
  Terms own;
  std::vector<int> inputs;
  for (const TraceStep& step : trace.steps()) {
    if (step.kind == TraceStep::Kind::input) inputs.push_back(own.input(step.index));
  }
  const int root = own.append(trace, inputs);
  return own.operations(root, most + 1) <= most;
}

// What a reader has to know about samples, in lines of comment.
std::string comment_of(const SampledFunction& sampled) {
  const std::array<Interval, 3>& box = sampled.samples().grid().box;
  std::string text = sampled.description() + ". That holds for inputs";
  for (int k = 0; k < sampled.info().arity; ++k) {
    text +=
        (k ? ", " : " ") + number_text(box[size_t(k)].lo) + " to " + number_text(box[size_t(k)].hi);
  }
  return comment_lines(text + "; others are moved to the nearest of these.");
}

bool is_operation(const Node* node) { return node->type == Node::Type::operation; }

// The nodes of one function's graph, inputs before their users, with their numbers of uses.
class Nodes {
 public:
  explicit Nodes(const Expression& root) : order_(topological_order(std::span(&root, 1))) {
    for (size_t i = 0; i < order_.size(); ++i) position_[order_[i]] = int(i);
    uses_.assign(order_.size(), 0);
    for (const Node* node : order_) {
      for (const Expression& input : node->arguments()) ++uses_[at(input)];
    }
  }

  const std::vector<const Node*>& order() const { return order_; }
  int at(const Expression& expression) const { return position_.at(expression.get()); }

  int uses(const Expression& expression) const { return uses_[at(expression)]; }

  // Whether nothing below the node is used but by the node and what is below it.
  bool is_private(int node) const {
    std::unordered_map<int, int> inner_uses;
    std::vector<int> pending{node};
    while (!pending.empty()) {
      const Node* next = order_[pending.back()];
      pending.pop_back();
      for (const Expression& input : next->arguments()) {
        if (is_operation(input.get()) && ++inner_uses[at(input)] == 1) pending.push_back(at(input));
      }
    }
    return std::all_of(inner_uses.begin(), inner_uses.end(),
                       [&](const auto& use) { return use.second == uses_[use.first]; });
  }

 private:
  std::vector<const Node*> order_;
  std::unordered_map<const Node*, int> position_;
  std::vector<int> uses_;
};

}  // namespace

std::string comment_lines(const std::string& text) {
  std::string out;
  for (size_t begin = 0; begin < text.size();) {
    size_t end = text.size();
    if (end - begin > comment_width) end = text.rfind(' ', begin + comment_width);
    if (end == std::string::npos || end <= begin) end = text.size();
    out += "// " + text.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return out;
}

std::vector<std::string> FunctionWriter::declare(std::span<const NamedExpression> expressions) {
  std::vector<Expression> roots;
  for (const NamedExpression& named : expressions) roots.push_back(named.expression);
  std::unordered_map<const Node*, size_t> position;
  for (const Node* node : topological_order(roots)) position.try_emplace(node, position.size());
  std::vector<size_t> order(roots.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return position.at(roots[a].get()) < position.at(roots[b].get());
  });
  std::vector<std::string> out(roots.size());
  for (size_t i : order) out[i] = declare(expressions[i]);
  return out;
}

std::string FunctionWriter::declare(const NamedExpression& expression) {
  try {
    return declare_function(names_.unique(expression.name), expression);
  } catch (const Error& error) {
    throw Error("'" + expression.name + "' cannot be written for POV-Ray: " + error.message,
                error.file, error.line, error.pointer);
  }
}

std::string FunctionWriter::declare_function(const std::string& name,
                                             const NamedExpression& named) {
  const Expression& expression = named.expression;
  if (!named.comment.empty()) printer_.comment(name, comment_lines(named.comment));
  Terms terms;
  for (int axis = 0; axis < 3; ++axis) terms.input(axis);
  int root;
  if (const auto known = named_.find(expression.get()); known != named_.end()) {
    root = terms.apply(known->second, {0, 1, 2});
  } else {
    root = add_terms(terms, expression);
    if (is_operation(expression.get())) {
      named_[expression.get()] = name;
      kept_alive_.push_back(expression);
    }
  }
  printer_.declare(name, terms, root, 3, InputNames::coordinates);
  return name;
}

std::string FunctionWriter::quick(const std::string& name, const Expression& expression) {
  Terms terms;
  for (int axis = 0; axis < 3; ++axis) terms.input(axis);
  is_quick_ = true;
  const int root = add_terms(terms, expression);
  is_quick_ = false;
  const auto [shorter, end] = with_short_linear_terms(terms, root);
  return printer_.quick(name, shorter, end);
}

int FunctionWriter::add_terms(Terms& terms, const Expression& root) {
  const Nodes nodes(root);
  const size_t n = nodes.order().size();
  std::vector<bool> needed(n, false), called(n, false);
  needed[n - 1] = true;
  for (size_t i = n; i-- > 0;) {
    if (!needed[i]) continue;
    called[i] = !is_quick_ && named_.contains(nodes.order()[i]) && nodes.is_private(int(i));
    if (called[i]) continue;
    for (const Expression& input : nodes.order()[i]->arguments()) needed[nodes.at(input)] = true;
  }
  std::vector<int> term(n, -1);
  for (size_t i = 0; i < n; ++i) {
    const Node* node = nodes.order()[i];
    if (!needed[i]) continue;
    if (called[i]) {
      term[i] = terms.apply(named_.at(node), {0, 1, 2});
    } else if (node->type == Node::Type::constant) {
      term[i] = terms.number(node->value);
    } else if (node->type == Node::Type::coordinate) {
      term[i] = terms.input(node->axis);
    } else {
      std::vector<int> inputs;
      for (const Expression& input : node->arguments()) inputs.push_back(term[nodes.at(input)]);
      term[i] = -1;
      for (int costly = node->arity - 1; costly >= 0 && term[i] < 0; --costly) {
        if (nodes.uses(node->inputs[costly]) > 1) continue;
        term[i] = add_guarded_call(terms, *node, inputs, costly,
                                   [&](const Expression& e) { return term[nodes.at(e)]; });
      }
      if (term[i] < 0) term[i] = add_call(terms, *node->operation, inputs);
    }
  }
  return term[n - 1];
}

// f(a, b) lies between a and f(a, B) where B is no less than b: if these two are equal, f(a, b) is
// a, and b need not be evaluated. -1 where that gains nothing.
int FunctionWriter::add_guarded_call(Terms& terms, const Node& node, std::span<const int> inputs,
                                     int costly,
                                     const std::function<int(const Expression&)>& term_of) {
  const Keeps keeps = keeps_other(*node.operation, costly);
  if (keeps == Keeps::nothing) return -1;
  const Expression bound = cheap_upper_bound(*node.inputs[costly]);
  if (!bound) return -1;
  std::vector<int> bound_inputs;
  for (const Expression& input : bound->arguments()) {
    const bool coordinate = input->type == Node::Type::coordinate;
    bound_inputs.push_back(coordinate ? terms.input(input->axis) : term_of(input));
    if (bound_inputs.back() < 0) return -1;  // inside a field that is called by its name
  }
  std::vector<int> cheap(inputs.begin(), inputs.end());
  cheap[costly] = add_call(terms, *bound->operation, bound_inputs);
  const int other = inputs[1 - costly];
  const int extreme = add_call(terms, *node.operation, cheap);
  const int full = add_call(terms, *node.operation, inputs);
  const int change = keeps == Keeps::other_or_more ? terms.apply("-", {other, extreme})
                                                   : terms.apply("-", {extreme, other});
  return terms.select(change, full, other, true);
}

int FunctionWriter::add_call(Terms& terms, const Operation& operation,
                             std::span<const int> inputs) {
  const OperationInfo& info = operation.info();
  if (is_quick_ && operation.has_formula()) {
    Trace trace(info.arity);
    operation.record(trace);
    if (is_short(trace, quick_operations)) return terms.append(trace, inputs);
  }
  const auto [known, added] = operations_.try_emplace({info.name, operation.numbers()});
  if (added) {
    const auto* sampled = dynamic_cast<const SampledFunction*>(&operation);
    known->second = sampled ? declare_samples(*sampled) : declare_operation(operation);
  }
  if (!known->second.empty()) {
    return terms.apply(known->second, std::vector<int>(inputs.begin(), inputs.end()));
  }
  Trace trace(info.arity);
  operation.record(trace);
  return terms.append(trace, inputs);
}

// The function's name, or "" if its text is as short as a call.
std::string FunctionWriter::declare_operation(const Operation& operation) {
  const OperationInfo& info = operation.info();
  if (!operation.has_formula()) {
    throw Error("'" + info.name + "' has no formula that POV-Ray could evaluate");
  }
  Trace trace(info.arity);
  operation.record(trace);
  if (is_short(trace, inlined_operations)) return "";
  Terms own;
  std::vector<int> own_inputs;
  for (int i = 0; i < info.arity; ++i) own_inputs.push_back(own.input(i));
  const int root = own.append(trace, own_inputs);
  const std::string name = names_.numbered(info.name);
  printer_.declare(name, own, root, info.arity, input_names(info));
  return name;
}

// Sample i of n lies at i / n in a density file. Outside of [0, 1) that is 0: inputs are clamped.
std::string FunctionWriter::declare_samples(const SampledFunction& sampled) {
  const Samples& samples = sampled.samples();
  const SampleGrid& grid = samples.grid();
  const std::string name = names_.numbered(sampled.exact().info().name);
  const std::string file = names_.unique(name + "_samples");
  printer_.insert(comment_of(sampled) + "#declare " + file +
                  " = function {\n  pattern { density_file df3 \"" + sampled.file() +
                  "\" interpolate 1 }\n}\n");
  Terms own;
  for (int i = 0; i < sampled.info().arity; ++i) own.input(i);
  std::vector<int> places;
  for (int k = 0; k < 3; ++k) {
    if (!grid.varies(k)) {
      places.push_back(own.number(0));
      continue;
    }
    const int from_first = own.apply("-", {own.input(k), own.number(grid.box[size_t(k)].lo)});
    const int place = own.apply("*", {from_first, own.number(1 / (grid.step(k) * grid.stored(k)))});
    const double last = double(grid.counts[k] - 1) / grid.stored(k);
    places.push_back(
        own.apply("min", {own.apply("max", {place, own.number(0)}), own.number(last)}));
  }
  const int scaled = own.apply("*", {own.number(samples.factor()), own.apply(file, places)});
  const int sum = own.apply("+", {own.number(samples.offset()), scaled});
  const int root = own.apply("max", {own.number(samples.range().lo), sum});
  printer_.declare(name, own, root, sampled.info().arity, input_names(sampled.info()));
  return name;
}

}  // namespace sardf::povray
