#include "sardf/kernels.hpp"

#include <cstdlib>

#include "sardf/error.hpp"
#include "sardf/kernel_table.hpp"

namespace sardf {

namespace {

InstructionSet widest() {
#if defined(SARDF_X86)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    return InstructionSet::avx512;
  }
  if (__builtin_cpu_supports("avx2")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

InstructionSet choose() {
  const InstructionSet most = widest();
  const char* wanted = std::getenv("SARDF_INSTRUCTION_SET");
  if (!wanted) return most;
  for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (instruction_set_name(set) == wanted) return std::min(set, most);
  }
  throw Error("SARDF_INSTRUCTION_SET is '" + std::string(wanted) +
              "'; accepted are baseline, avx2 and avx512");
}

}  // namespace

InstructionSet instruction_set() {
  static const InstructionSet chosen = choose();
  return chosen;
}

std::string instruction_set_name(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
    default:
      return "baseline";
  }
}

ChainKernel chain_kernel() {
#if defined(SARDF_X86)
  if (instruction_set() == InstructionSet::avx512) return avx512_chain();
  if (instruction_set() == InstructionSet::avx2) return avx2_chain();
#endif
  return &chain_term<Baseline>;
}

const Kernels* listed_kernels(InstructionSet set, const std::string& operation) {
  const KernelTable* table = &baseline_kernels();
#if defined(SARDF_X86)
  if (set == InstructionSet::avx2) table = &avx2_kernels();
  if (set == InstructionSet::avx512) table = &avx512_kernels();
#endif
  const auto found = table->find(operation);
  return found == table->end() ? nullptr : found->second;
}

}  // namespace sardf
