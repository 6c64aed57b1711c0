// The kernels of the whole operation list for one instruction set, by the operations' names.
#pragma once

#include <string>
#include <unordered_map>

#include "sardf/kernels.hpp"
#include "sardf/ops.hpp"

namespace sardf {

using KernelTable = std::unordered_map<std::string, const Kernels*>;

template <class Isa>
KernelTable kernel_table() {
  KernelTable table;
  Ops::for_each([&]<class Op>(std::type_identity<Op>) {
    table.emplace(Op::name, &KernelsOf<Op, Isa>::table);
  });
  return table;
}

const KernelTable& baseline_kernels();
const KernelTable& avx2_kernels();
const KernelTable& avx512_kernels();
ChainKernel avx2_chain();
ChainKernel avx512_chain();

}  // namespace sardf
