// A graph as a straight-line program with several outputs, over registers that are reused.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sardf/graph.hpp"

namespace sardf {

struct Instruction {
  const Operation* operation;
  std::array<uint32_t, max_arity> in;
  uint32_t out;
};

/// Registers 0, 1, 2 hold x, y, z; then come the constants', which are filled once; the others are
/// shared by values whose lives do not overlap.
class Tape {
 public:
  Tape() = default;
  explicit Tape(std::span<const Expression> outputs);
  explicit Tape(const Expression& output) : Tape(std::span(&output, 1)) {}

  const std::vector<Instruction>& instructions() const { return instructions_; }
  /// The register of each output.
  const std::vector<uint32_t>& outputs() const { return outputs_; }
  size_t registers() const { return registers_; }
  struct Constant {
    uint32_t reg;
    double value;
  };
  const std::vector<Constant>& constants() const { return constants_; }

 private:
  std::vector<Expression> kept_alive_;
  std::vector<Instruction> instructions_;
  std::vector<Constant> constants_;
  std::vector<uint32_t> outputs_;
  size_t registers_ = 3;
};

}  // namespace sardf
