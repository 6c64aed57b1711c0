// Memory for large arrays whose elements begin as zeros without being written.
#pragma once

#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

// Address sanitizers watch over malloc's memory only.
#if defined(__SANITIZE_ADDRESS__)
#define SARDF_MAPS_MEMORY 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SARDF_MAPS_MEMORY 0
#endif
#endif
#if defined(__linux__)
#include <sys/mman.h>
#ifndef SARDF_MAPS_MEMORY
#define SARDF_MAPS_MEMORY 1
#endif
#endif

namespace sardf {

inline constexpr size_t large_page = size_t(2) << 20;

/// Reserves room for n elements, in large pages where it has whole ones; it is no loss where the
/// system refuses.
template <class T>
void reserve_large(std::vector<T>& empty, size_t n) {
  empty.reserve(n);
#if defined(__linux__)
  const size_t at = reinterpret_cast<size_t>(empty.data());
  // Large arrays begin a few bytes after the beginning of a page.
  constexpr size_t little = 4096;
  const size_t begin = (at + large_page - little) / large_page * large_page;
  const size_t end = (at + n * sizeof(T)) / large_page * large_page;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

/// Makes an empty vector n elements long, in large pages.
template <class T>
void resize_large(std::vector<T>& empty, size_t n) {
  reserve_large(empty, n);
  empty.resize(n);
}

#if SARDF_MAPS_MEMORY
/// Zeros in large pages of their own. One takes a sixteenth of the time of the small ones in its
/// place, so it is worth its memory where as much of it is used.
struct MappedZeros {
  static bool serve(size_t bytes) { return bytes >= large_page / 16; }
  static size_t room(size_t bytes) { return (bytes + large_page - 1) / large_page * large_page; }

  /// Null where there is no memory.
  static void* make(size_t bytes) {
    // Pages begin at multiples of their size: what is before the first and behind the last goes.
    void* const all = mmap(nullptr, room(bytes) + large_page, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (all == MAP_FAILED) return nullptr;
    const size_t before = (large_page - reinterpret_cast<size_t>(all) % large_page) % large_page;
    char* const begin = static_cast<char*>(all) + before;
    if (before > 0) munmap(all, before);
    munmap(begin + room(bytes), large_page - before);
    madvise(begin, room(bytes), MADV_HUGEPAGE);
    return begin;
  }
  static void end(void* memory, size_t bytes) { munmap(memory, room(bytes)); }
};
#else
struct MappedZeros {
  static bool serve(size_t) { return false; }
  static void* make(size_t) { return nullptr; }
  static void end(void*, size_t) {}
};
#endif

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
    const size_t bytes = n * sizeof(T);
    void* memory = MappedZeros::serve(bytes) ? MappedZeros::make(bytes) : std::calloc(n, sizeof(T));
    if (!memory) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t n) {
    const size_t bytes = n * sizeof(T);
    MappedZeros::serve(bytes) ? MappedZeros::end(memory, bytes) : std::free(memory);
  }

  template <class U>
  void construct(U*) {}
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const ZeroedMemory&, const ZeroedMemory&) { return true; }
};

}  // namespace sardf
