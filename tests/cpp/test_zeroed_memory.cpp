// Arrays that begin as zeros, of sizes on both sides of where they have pages of their own.
#include "sardf/zeroed_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <numeric>

namespace sardf {
namespace {

using Zeroed = std::vector<uint32_t, ZeroedMemory<uint32_t>>;

constexpr size_t kib = 1024 / sizeof(uint32_t);
constexpr size_t sizes[] = {1,         100,        128 * kib - 1,  128 * kib,
                            200 * kib, 2048 * kib, 2048 * kib + 1, 5000 * kib};

TEST(ZeroedMemory, BeginsAsZerosToItsEnd) {
  for (const size_t n : sizes) {
    // The second has the memory that the first has written to, if it is given out again.
    for (int round = 0; round < 2; ++round) {
      Zeroed array(n);
      EXPECT_EQ(std::count(array.begin(), array.end(), 0u), std::ptrdiff_t(n)) << n;
      std::iota(array.begin(), array.end(), 1u);
      EXPECT_EQ(array.back(), uint32_t(n));
    }
  }
}

TEST(ZeroedMemory, KeepsWhatIsThereAsItGrows) {
  Zeroed array;
  for (const size_t n : sizes) {
    const size_t before = array.size();
    array.resize(n);
    for (size_t i = 0; i < n; ++i) {
      ASSERT_EQ(array[i], i < before ? uint32_t(i + 1) : 0u) << n;
      array[i] = uint32_t(i + 1);
    }
  }
  const Zeroed copy = array;
  const Zeroed moved = std::move(array);
  EXPECT_EQ(copy, moved);
  EXPECT_EQ(moved.size(), sizes[std::size(sizes) - 1]);
}

/// Bytes of address space.
size_t mapped() {
  size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * 4096;
}

TEST(ZeroedMemory, IsGivenBack) {
  const auto use = [](int times) {
    for (int i = 0; i < times; ++i) {
      for (const size_t n : sizes) Zeroed(n).back() = 1;
    }
  };
  use(2);
  const size_t before = mapped();
  use(100);  // nearly 1 GiB in all; sanitizers keep a quarter of one for a while
  EXPECT_LE(mapped(), before + (size_t(512) << 20));
}

// But where a sanitizer watches over malloc's memory.
TEST(ZeroedMemory, HasLargePagesOfItsOwn) {
  const bool maps = MappedZeros::serve(large_page);
  for (const size_t n : sizes) {
    const Zeroed array(n);
    const bool is_mapped = MappedZeros::serve(n * sizeof(uint32_t));
    EXPECT_EQ(is_mapped, maps && n >= 128 * kib) << n;
    if (is_mapped) {
      EXPECT_EQ(reinterpret_cast<uintptr_t>(array.data()) % large_page, 0u) << n;
    }
  }
}

}  // namespace
}  // namespace sardf
