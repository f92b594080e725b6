#include "dreampm/base/narrow.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace dreampm {
namespace {

TEST(Narrow, KeepsWhatFitsAndRefusesTheNextNumber) {
  EXPECT_EQ(narrow<std::uint8_t>(255, "materials"), 255);
  EXPECT_EQ(narrow<std::int32_t>(std::size_t{0x7fffffff}, "particles"), 0x7fffffff);
  EXPECT_EQ(narrow<std::int32_t>(std::int64_t{-5}, "places"), -5);
  EXPECT_THROW(narrow<std::int32_t>(std::size_t{0x80000000}, "particles"), RunError);
  EXPECT_THROW(narrow<std::uint32_t>(-1, "particles"), RunError);
  try {
    narrow<std::uint8_t>(256, "materials");
    FAIL() << "256 does not fit";
  } catch (const RunError& e) {
    EXPECT_STREQ(e.what(), "256 materials are more than this program can number: at most 255");
  }
}

}  // namespace
}  // namespace dreampm
