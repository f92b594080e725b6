#include "dreampm/base/order.h"

#include <gtest/gtest.h>

#include <limits>

namespace dreampm {
namespace {

template <class T>
void expect_in_order(const std::vector<T>& numbers) {
  std::vector<std::uint32_t> expected(numbers.size());
  std::iota(expected.begin(), expected.end(), 0u);
  std::sort(expected.begin(), expected.end(), [&](auto a, auto b) { return numbers[a] < numbers[b]; });
  EXPECT_EQ(order_of(std::span<const T>(numbers)), expected);
}

TEST(Order, CloseAndFarNumbers) {
  expect_in_order<std::uint32_t>({});
  expect_in_order<std::uint32_t>({7});
  expect_in_order<std::uint32_t>({3, 0, 2, 1});
  expect_in_order<std::uint32_t>({12, 10, 17, 11});
  expect_in_order<std::uint32_t>({5, 4000000000u, 3, 70, 2});
  expect_in_order<std::int32_t>({-3, 4, -1, 0});
  expect_in_order<std::int32_t>(
      {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min(), 0});
  // Either side of where it sorts instead.
  for (const std::uint32_t step : {3u, 4u, 5u}) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < 1000; ++i) numbers.push_back(9 + i * 617 % 1000 * step);
    expect_in_order(numbers);
  }
}

}  // namespace
}  // namespace dreampm
