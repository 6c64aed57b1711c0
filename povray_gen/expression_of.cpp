#include "povray_gen/expression_of.hpp"

namespace sardf::povray {

Expression expression_of(const Evaluator& evaluator) {
  const Tape& tape = evaluator.tape();
  std::vector<Expression> registers(tape.registers());
  for (int axis = 0; axis < 3; ++axis) registers[size_t(axis)] = coordinate(axis);
  for (const Tape::Constant& c : tape.constants()) registers[c.reg] = constant(c.value);
  for (const Instruction& i : tape.instructions()) {
    const int arity = i.operation->info().arity;
    if (arity == 0) {
      registers[i.out] = constant(i.operation->evaluate(static_cast<const double*>(nullptr)));
      continue;
    }
    std::vector<Expression> inputs;
    for (int k = 0; k < arity; ++k) inputs.push_back(registers[i.in[k]]);
    // The tape's source keeps the operation alive.
    registers[i.out] = call(OperationPointer(tape.source(), i.operation), inputs);
  }
  return registers[tape.outputs()[0]];
}

}  // namespace sardf::povray
