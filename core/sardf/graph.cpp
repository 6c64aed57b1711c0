#include "sardf/graph.hpp"

#include <bit>
#include <cassert>
#include <mutex>
#include <unordered_map>

namespace sardf {

namespace {

size_t mix(size_t hash, uint64_t word) {
  hash ^= word + 0x9E3779B97F4A7C15ull + (hash << 6) + (hash >> 2);
  return hash;
}

size_t hash_of(const Node& node) {
  size_t hash = mix(size_t(node.type), node.axis);
  hash = mix(hash, std::bit_cast<uint64_t>(node.value));
  if (node.operation) {
    hash = mix(hash, std::hash<std::string>{}(node.operation->info().name));
    for (double a : node.operation->numbers()) hash = mix(hash, std::bit_cast<uint64_t>(a));
  }
  for (const Expression& input : node.arguments()) {
    hash = mix(hash, std::bit_cast<uintptr_t>(input.get()));
  }
  return hash;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::bit_cast<uint64_t>(a[i]) != std::bit_cast<uint64_t>(b[i])) return false;
  }
  return true;
}

bool same(const Node& a, const Node& b) {
  if (a.type != b.type || a.axis != b.axis || a.arity != b.arity) return false;
  if (std::bit_cast<uint64_t>(a.value) != std::bit_cast<uint64_t>(b.value)) return false;
  if (a.inputs != b.inputs) return false;
  if (a.operation == b.operation) return true;
  return a.operation->info().name == b.operation->info().name &&
         same_bits(a.operation->numbers(), b.operation->numbers());
}

// Every live node by its hash. It outlives all expressions, static ones included.
class Table {
 public:
  static Table& instance() {
    static Table* table = new Table;
    return *table;
  }

  Expression intern(Node node) {
    const size_t hash = hash_of(node);
    const std::scoped_lock lock(mutex_);
    const auto [first, last] = nodes_.equal_range(hash);
    for (auto at = first; at != last; ++at) {
      // A node whose last handle is being dropped cannot be revived: a new one takes its place.
      if (!same(*at->second.pointer, node)) continue;
      if (Expression alive = at->second.handle.lock()) return alive;
    }
    const Node* added = new Node(std::move(node));
    Expression handle(added, &Table::release);
    nodes_.emplace(hash, Entry{added, handle});
    return handle;
  }

  size_t size() {
    const std::scoped_lock lock(mutex_);
    return nodes_.size();
  }

 private:
  struct Entry {
    const Node* pointer;
    std::weak_ptr<const Node> handle;
  };

  // Called when a node's last handle goes. Deleting it drops its inputs, which calls this again:
  // they queue up instead of recursing.
  static void release(const Node* node) {
    thread_local std::vector<const Node*>* queue = nullptr;
    if (queue) {
      queue->push_back(node);
      return;
    }
    std::vector<const Node*> pending{node};
    queue = &pending;
    while (!pending.empty()) {
      const Node* next = pending.back();
      pending.pop_back();
      instance().forget(next);
      delete next;
    }
    queue = nullptr;
  }

  void forget(const Node* node) {
    const std::scoped_lock lock(mutex_);
    const auto [first, last] = nodes_.equal_range(hash_of(*node));
    for (auto at = first; at != last; ++at) {
      if (at->second.pointer != node) continue;
      nodes_.erase(at);
      return;
    }
  }

  std::mutex mutex_;
  std::unordered_multimap<size_t, Entry> nodes_;
};

}  // namespace

Expression constant(double value) {
  Node node;
  node.value = value;
  return Table::instance().intern(std::move(node));
}

Expression coordinate(int axis) {
  assert(0 <= axis && axis < 3);
  Node node;
  node.type = Node::Type::coordinate;
  node.axis = uint8_t(axis);
  node.coordinates = uint8_t(1 << axis);
  return Table::instance().intern(std::move(node));
}

bool is_constant(const Expression& expression) { return expression->type == Node::Type::constant; }

Expression call(const OperationPointer& operation, std::initializer_list<Expression> inputs) {
  return call(operation, std::span(inputs.begin(), inputs.size()));
}

Expression call(const OperationPointer& operation, std::span<const Expression> inputs) {
  assert(int(inputs.size()) == operation->info().arity);
  Node node;
  node.type = Node::Type::operation;
  node.arity = uint8_t(inputs.size());
  node.operation = operation;
  bool folds = true;
  std::array<double, max_arity> values{};
  for (size_t i = 0; i < inputs.size(); ++i) {
    node.inputs[i] = inputs[i];
    node.coordinates |= inputs[i]->coordinates;
    folds = folds && is_constant(inputs[i]);
    values[i] = inputs[i]->value;
  }
  if (folds) return constant(operation->evaluate(values.data()));
  return Table::instance().intern(std::move(node));
}

Expression Operation::derivative(int, std::span<const Expression>) const { return nullptr; }

std::vector<const Node*> topological_order(std::span<const Expression> roots) {
  std::vector<const Node*> order;
  std::unordered_map<const Node*, bool> done;
  std::vector<std::pair<const Node*, int>> stack;
  for (const Expression& root : roots) {
    stack.push_back({root.get(), 0});
    while (!stack.empty()) {
      auto& [node, next] = stack.back();
      if (next == 0 && !done.try_emplace(node, false).second) {
        stack.pop_back();
        continue;
      }
      if (next < node->arity) {
        const Node* input = node->inputs[next++].get();
        stack.push_back({input, 0});
        continue;
      }
      order.push_back(node);
      stack.pop_back();
    }
  }
  return order;
}

std::vector<Expression> substitute(std::span<const Expression> expressions,
                                   const std::array<Expression, 3>& coordinates) {
  std::unordered_map<const Node*, Expression> replaced;
  for (const Node* node : topological_order(expressions)) {
    if (node->type == Node::Type::coordinate) {
      replaced[node] = coordinates[node->axis];
    } else if (node->type == Node::Type::operation && node->coordinates) {
      std::array<Expression, max_arity> inputs;
      for (int i = 0; i < node->arity; ++i) {
        const Expression& input = node->inputs[i];
        inputs[i] = input->coordinates ? replaced.at(input.get()) : input;
      }
      replaced[node] = call(node->operation, std::span(inputs.data(), node->arity));
    }
  }
  std::vector<Expression> out;
  for (const Expression& e : expressions) {
    out.push_back(e->coordinates ? replaced.at(e.get()) : e);
  }
  return out;
}

Expression substitute(const Expression& expression, const std::array<Expression, 3>& coordinates) {
  return substitute(std::span(&expression, 1), coordinates)[0];
}

size_t live_nodes() { return Table::instance().size(); }

}  // namespace sardf
