// Vectors that a step goes through from end to end, on large pages.
#pragma once
#include <cstddef>
#include <limits>
#include <new>
#include <vector>

namespace dreampm {

inline constexpr std::size_t large_page = std::size_t{2} << 20;

/// Memory for `bytes`, of a system that has them on large pages, except for what would fill less than `least_used` [bytes]
/// of one: that lies on small ones. On small pages alone a step spends some per cent of its time on looking them up,
/// and on lines that happen to want the same place in the cache. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes, std::size_t least_used);
/// `bytes`, `least_used`: as they were when it was allocated.
void free_large(void* memory, std::size_t bytes, std::size_t least_used) noexcept;

template <class T, std::size_t least_used>
struct LargePages {
  using value_type = T;
  template <class U>
  struct rebind {
    using other = LargePages<U, least_used>;
  };
  static_assert(alignof(T) <= 64 && least_used <= large_page);

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U, least_used>&) noexcept {}
  T* allocate(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / 2 / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_large(n * sizeof(T), least_used));
  }
  void deallocate(T* memory, std::size_t n) noexcept { free_large(memory, n * sizeof(T), least_used); }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

template <class T, std::size_t least_used = large_page / 2>
using LargeVector = std::vector<T, LargePages<T, least_used>>;

}  // namespace dreampm
