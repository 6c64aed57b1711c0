#include "sardf/kernel_table.hpp"

namespace sardf {

const KernelTable& avx512_kernels() {
  static const KernelTable table = kernel_table<Avx512>();
  return table;
}

ChainKernel avx512_chain() { return &chain_term<Avx512>; }

}  // namespace sardf
