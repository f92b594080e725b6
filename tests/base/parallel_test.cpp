#include "dreampm/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace dreampm;

namespace {

TEST(Parallel, EveryIndexOnceForAnyThreadsAndGrain) {
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{100'003}})
      for (const std::size_t grain : {std::size_t{0}, std::size_t{1}, std::size_t{64}, std::size_t{1'000'000}}) {
        std::vector<std::atomic<int>> visits(n);
        std::atomic<bool> sane = true;
        parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
          if (begin >= end || end > n) {
            sane = false;
            return;
          }
          for (std::size_t i = begin; i < end; ++i) visits[i].fetch_add(1);
        });
        EXPECT_TRUE(sane) << "an empty or overlong range";
        std::size_t wrong = 0;
        for (const auto& v : visits) wrong += v != 1;
        EXPECT_EQ(wrong, 0u) << n << " items, grain " << grain << ", threads " << threads;
      }
  }
}

TEST(Parallel, LimitIsInForceOnlyWhileItLives) {
  const int before = thread_count();
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(thread_count(), 1);
    std::atomic<int> at_once = 0, most = 0;
    parallel_for(200, 1, [&](std::size_t) {
      const int now = ++at_once;
      int seen = most;
      while (now > seen && !most.compare_exchange_weak(seen, now)) {
      }
      --at_once;
    });
    EXPECT_EQ(most, 1);
  }
  EXPECT_EQ(thread_count(), before);
}

TEST(Parallel, LoopsOfABodyStayOnItsThread) {
  const ThreadLimit limit(4);
  std::atomic<int> strangers = 0;
  on_this_thread([&] {
    const auto mine = std::this_thread::get_id();
    parallel_for(500, 1, [&](std::size_t) { strangers += std::this_thread::get_id() != mine; });
  });
  EXPECT_EQ(strangers, 0);
}

TEST(Parallel, SumsHaveTheSameBitsForAnyNumberOfThreads) {
  const auto add = [](float& sum, std::size_t i) { sum += 1 / static_cast<float>(i + 1); };
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{65}, std::size_t{100'003}}) {
    double exact = 0;
    for (std::size_t i = n; i > 0; --i) exact += 1 / static_cast<double>(i);
    std::vector<float> sums;
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadLimit limit(threads);
      sums.push_back(parallel_reduce(n, 0.0f, add));
    }
    EXPECT_NEAR(static_cast<double>(sums[0]), exact, 1e-5 * exact) << n;
    for (const float sum : sums) EXPECT_EQ(sum, sums[0]) << n;
  }
  // Pieces are joined in their order.
  const auto letters =
      parallel_reduce(26, std::string(), [](std::string& text, std::size_t i) { text += static_cast<char>('a' + i); });
  EXPECT_EQ(letters, "abcdefghijklmnopqrstuvwxyz");
}

TEST(Parallel, AnErrorInTheBodyReachesTheCaller) {
  EXPECT_THROW(parallel_for(1000, 1,
                            [](std::size_t i) {
                              if (i == 500) throw std::runtime_error("item 500");
                            }),
               std::runtime_error);
}

}  // namespace
