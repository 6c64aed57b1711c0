// A graph as a straight-line program with several outputs, over registers that are reused.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sardf/graph.hpp"

namespace sardf {

struct Instruction {
  const Operation* operation;
  // The operation's own, asked for once and not by two virtual calls for each block.
  const Kernels* kernels;
  const void* object;
  std::array<uint32_t, max_arity> in;
  uint32_t out;
  // How many instructions from this one on a single call may evaluate (Kernels::together): 1 or, at
  // the first of several, their number.
  uint32_t together = 1;
  // If one call evaluates this one and the next, and nothing else needs this one's result: by what,
  // and how many such pairs from this one on it evaluates.
  const Fused* fused = nullptr;
  uint32_t pairs = 1;
};

/// A program whose values are numbered: 0, 1, 2 are x, y, z, then come the constants, then the
/// results of the steps, in order.
struct Code {
  struct Step {
    const Operation* operation;
    std::array<uint32_t, max_arity> in;  // values
  };
  std::vector<double> constants;
  std::vector<Step> steps;
  std::vector<uint32_t> outputs;  // values
  /// Keeps the operations alive.
  std::shared_ptr<const void> source;
};

/// Registers 0, 1, 2 hold x, y, z; then come the constants', which are filled once; the others are
/// shared by values whose lives do not overlap. Of very many constants only some have a register of
/// their own; instructions without inputs make the others where they are needed.
class Tape {
 public:
  Tape() = default;
  explicit Tape(std::span<const Expression> outputs);
  explicit Tape(const Expression& output) : Tape(std::span(&output, 1)) {}
  explicit Tape(const Code& code);

  const std::vector<Instruction>& instructions() const { return instructions_; }
  /// The register of each output.
  const std::vector<uint32_t>& outputs() const { return outputs_; }
  size_t registers() const { return registers_; }
  struct Constant {
    uint32_t reg;
    double value;
  };
  const std::vector<Constant>& constants() const { return constants_; }
  /// Only copies of a tape have the same number.
  uint64_t number() const { return number_; }
  /// What keeps the operations alive.
  const std::shared_ptr<const void>& source() const { return source_; }

 private:
  // Both with last[s], the instruction that uses the result of s last.
  void find_pairs(const Code& code, std::span<const uint32_t> last);
  void place_results(std::vector<uint32_t> last);

  std::shared_ptr<const void> source_;
  std::vector<Instruction> instructions_;
  std::vector<Constant> constants_;
  std::vector<uint32_t> outputs_;
  size_t registers_ = 3;
  uint64_t number_ = 0;
};

}  // namespace sardf
