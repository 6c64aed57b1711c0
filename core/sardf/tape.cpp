#include "sardf/tape.hpp"

#include <unordered_map>

namespace sardf {

Tape::Tape(std::span<const Expression> outputs) : kept_alive_(outputs.begin(), outputs.end()) {
  const std::vector<const Node*> order = topological_order(outputs);
  std::unordered_map<const Node*, uint32_t> uses, place;
  for (const Node* node : order) {
    for (const Expression& input : node->arguments()) ++uses[input.get()];
  }
  for (const Expression& output : outputs) ++uses[output.get()];

  std::vector<uint32_t> free;
  for (const Node* node : order) {
    if (node->type == Node::Type::coordinate) {
      place[node] = node->axis;
    } else if (node->type == Node::Type::constant) {
      place[node] = uint32_t(registers_++);
      constants_.push_back({place[node], node->value});
    }
  }
  for (const Node* node : order) {
    if (node->type != Node::Type::operation) continue;
    Instruction instruction{node->operation.get(), {}, 0};
    for (int i = 0; i < node->arity; ++i) instruction.in[i] = place[node->inputs[i].get()];
    // The result may not overwrite an input: kernels read and write in steps of their own width.
    if (free.empty()) {
      instruction.out = uint32_t(registers_++);
    } else {
      instruction.out = free.back();
      free.pop_back();
    }
    for (const Expression& input : node->arguments()) {
      if (--uses[input.get()] == 0 && input->type == Node::Type::operation) {
        free.push_back(place[input.get()]);
      }
    }
    place[node] = instruction.out;
    instructions_.push_back(instruction);
  }
  for (const Expression& output : outputs) outputs_.push_back(place[output.get()]);
}

}  // namespace sardf
