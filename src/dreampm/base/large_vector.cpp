#include "dreampm/base/large_vector.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace dreampm {
namespace {

constexpr std::align_val_t line{64};

#ifdef __linux__
constexpr std::size_t up(std::size_t bytes) { return (bytes + large_page - 1) / large_page * large_page; }

/// Columns that began at the same place of a page would want the same lines of the cache, one
/// element of each after the other. So they begin apart: 16 of them, two pages of 4 KiB and four
/// lines from each other.
std::size_t offset_in(std::uintptr_t page) { return page / large_page % 16 * (2 * 4096 + 4 * 64); }
#endif

}  // namespace

void* allocate_large(std::size_t bytes, [[maybe_unused]] std::size_t least) {
#ifdef __linux__
  if (bytes >= least) {
    // One page more than it takes, wherever the system puts it: room to begin at a whole one.
    const std::size_t most = up(bytes + offset_in(15 * large_page)) + large_page;
    void* const mapped = mmap(nullptr, most, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    const auto begin = reinterpret_cast<std::uintptr_t>(mapped), first = up(begin);
    const std::size_t used = offset_in(first) + bytes, kept = up(used);
    if (first > begin) munmap(mapped, first - begin);
    munmap(reinterpret_cast<void*>(first + kept), begin + most - (first + kept));
    // A wish: where it is not granted pages are small.
    const std::size_t large = kept > large_page && kept - used > large_page / 2 ? kept - large_page : kept;
    madvise(reinterpret_cast<void*>(first), large, MADV_HUGEPAGE);
    return reinterpret_cast<void*>(first + offset_in(first));
  }
#endif
  return ::operator new(bytes, line);
}

void free_large(void* memory, [[maybe_unused]] std::size_t bytes, [[maybe_unused]] std::size_t least) noexcept {
#ifdef __linux__
  if (bytes >= least) {
    const auto first = reinterpret_cast<std::uintptr_t>(memory) / large_page * large_page;
    munmap(reinterpret_cast<void*>(first), up(offset_in(first) + bytes));
    return;
  }
#endif
  ::operator delete(memory, line);
}

}  // namespace dreampm
