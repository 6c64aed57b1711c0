// Memory for large arrays whose elements begin as zeros without being written.
#pragma once

#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace sardf {

/// Asks for large pages where a large array has whole ones; it is no loss where the system refuses.
inline void use_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] size_t bytes) {
#if defined(__linux__)
  constexpr size_t page = size_t(2) << 20;
  const size_t begin = (reinterpret_cast<size_t>(memory) + page - 1) / page * page;
  const size_t end = (reinterpret_cast<size_t>(memory) + bytes) / page * page;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

/// Makes an empty vector n elements long, in large pages.
template <class T>
void resize_large(std::vector<T>& empty, size_t n) {
  empty.reserve(n);
  use_large_pages(empty.data(), n * sizeof(T));
  empty.resize(n);
}

/// An allocator for std::vector: elements that are made without a value are 0, since they lie in
/// memory that the system hands out as zeros. Pages come into being where they are first touched,
/// by the threads that work there. Not for vectors that shrink and grow again within their
/// capacity: then what was there before is back.
template <class T>
struct ZeroedMemory {
  using value_type = T;
  ZeroedMemory() = default;
  template <class U>
  explicit ZeroedMemory(const ZeroedMemory<U>&) {}

  T* allocate(size_t n) {
    void* memory = std::calloc(n, sizeof(T));
    if (!memory) throw std::bad_alloc();
    use_large_pages(memory, n * sizeof(T));
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t) { std::free(memory); }

  template <class U>
  void construct(U*) {}
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const ZeroedMemory&, const ZeroedMemory&) { return true; }
};

}  // namespace sardf
