#include "sardf/kernel_table.hpp"

namespace sardf {

const KernelTable& avx2_kernels() {
  static const KernelTable table = kernel_table<Avx2>();
  return table;
}

ChainKernel avx2_chain() { return &chain_term<Avx2>; }

}  // namespace sardf
