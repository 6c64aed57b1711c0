#include "sardf/kernel_table.hpp"

namespace sardf {

const KernelTable& baseline_kernels() {
  static const KernelTable table = kernel_table<Baseline>();
  return table;
}

}  // namespace sardf
