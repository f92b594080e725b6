// Vectors that a step goes through from end to end, on large pages.
#pragma once
#include <cstddef>
#include <limits>
#include <new>
#include <vector>

namespace dreampm {

inline constexpr std::size_t large_page = std::size_t{2} << 20;

/// Memory for `bytes`, on large pages where the system has them; on small ones if it is less than
/// `least` [bytes], and the end of what is longer, if that would fill less than half of a page. On
/// small pages alone a step spends some per cent of its time on looking them up, and on lines that
/// happen to want the same place in the cache. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes, std::size_t least);
/// `bytes`, `least`: as they were when it was allocated.
void free_large(void* memory, std::size_t bytes, std::size_t least) noexcept;

template <class T, std::size_t least>
struct LargePages {
  using value_type = T;
  template <class U>
  struct rebind {
    using other = LargePages<U, least>;
  };
  static_assert(alignof(T) <= 64);

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U, least>&) noexcept {}
  T* allocate(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / 2 / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_large(n * sizeof(T), least));
  }
  void deallocate(T* memory, std::size_t n) noexcept { free_large(memory, n * sizeof(T), least); }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

/// `least`: as in allocate_large.
template <class T, std::size_t least = large_page / 4 * 3>
using LargeVector = std::vector<T, LargePages<T, least>>;

}  // namespace dreampm
