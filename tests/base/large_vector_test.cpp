#include "dreampm/base/large_vector.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace dreampm {
namespace {

std::uintptr_t address(const void* p) { return reinterpret_cast<std::uintptr_t>(p); }

TEST(LargeVector, IsAVectorOfAnyLength) {
  constexpr std::size_t page = large_page / sizeof(std::uint32_t);
  for (const std::size_t size :
       {std::size_t{1}, page / 4 * 3 - 1, page / 4 * 3, page - 1, page, page + 1, 2 * page, 5 * page + 3}) {
    LargeVector<std::uint32_t> numbers(size);
    EXPECT_EQ(address(numbers.data()) % 64, 0u) << size;
    std::iota(numbers.begin(), numbers.end(), 7u);
    LargeVector<std::uint32_t> copy = numbers, moved = std::move(numbers);
    moved.resize(size + page);
    ASSERT_EQ(moved.size(), size + page);
    copy.swap(moved);
    for (std::size_t i = 0; i < size; ++i) ASSERT_TRUE(copy[i] == i + 7 && moved[i] == i + 7) << size;
    for (std::size_t i = size; i < copy.size(); ++i) ASSERT_EQ(copy[i], 0u);
  }
}

#ifdef __linux__
/// Returns the pages mapped by this process [pages], touched or not.
std::size_t pages_mapped() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages;
}

TEST(LargeVector, GivesItsMemoryBack) {
  constexpr std::size_t size = 40 * large_page + 1000;
  const auto use = [] { LargeVector<char>(size).swap(*std::make_unique<LargeVector<char>>(size + large_page)); };
  use();
  const std::size_t before = pages_mapped();
  ASSERT_GT(before, 0u);
  for (int i = 0; i < 10; ++i) use();
  EXPECT_LT(pages_mapped(), before + size / 4096);
}
#endif

TEST(LargeVector, SaysWhatItCannotHave) {
  LargeVector<double> numbers;
  EXPECT_THROW(numbers.reserve(std::size_t{1} << 57), std::bad_alloc);
  EXPECT_THROW(numbers.reserve(numbers.max_size() + 1), std::length_error);
}

/// Returns the kernel's flags of the mapping that holds `p`: "hg" where large pages are wished for.
std::string flags_of(const void* p) {
  std::ifstream maps("/proc/self/smaps");
  bool here = false;
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::uintptr_t begin, end;
    char dash;
    if (words >> std::hex >> begin >> dash >> end && dash == '-') here = begin <= address(p) && address(p) < end;
    if (here && line.starts_with("VmFlags:")) return line;
  }
  return "";
}

TEST(LargeVector, WishesForLargePagesWhereTheyAreUsed) {
  const bool known = std::filesystem::exists("/sys/kernel/mm/transparent_hugepage");
  const auto large = [](const void* p) { return flags_of(p).find(" hg") != std::string::npos; };
  const LargeVector<char> whole(3 * large_page), most(large_page / 4 * 3), small(large_page / 4 * 3 - 1),
      rest(2 * large_page + large_page / 4);
  const LargeVector<char, 0> one(1);
  // A system that knows no large pages grants none, and all else goes on.
  for (const char* p : {&whole.front(), &whole[2 * large_page], &most.front(), &rest.front(), &one.front()})
    EXPECT_EQ(large(p), known);
  for (const char* p : {&small.front(), &rest.back()}) EXPECT_FALSE(large(p));
}

}  // namespace
}  // namespace dreampm
