#include "dreampm/base/thread_team.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "dreampm/base/parallel.h"

using namespace dreampm;

namespace {

TEST(ThreadTeam, ALoopSeesAllOfTheOneBefore) {
  constexpr std::size_t n = 1003;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    for (const std::size_t grain : {std::size_t{1}, std::size_t{7}, std::size_t{5000}}) {
      // Each item adds up two of the round before, from opposite ends: Pascal's triangle round a
      // circle.
      std::vector<std::uint64_t> even(n, 1), odd(n, 0);
      parallel_region([&](ThreadTeam& team) {
        for (int round = 0; round < 40; ++round) {
          auto& from = round % 2 ? odd : even;
          auto& to = round % 2 ? even : odd;
          team.loop(n, grain, [&](std::size_t i) { to[i] = from[n - 1 - i] + from[(i + n / 2) % n]; });
          team.loop(0, grain, [&](std::size_t) { to.at(n); });
        }
      });
      std::size_t wrong = 0;
      for (const std::uint64_t v : even) wrong += v != std::uint64_t{1} << 40;
      EXPECT_EQ(wrong, 0u) << threads << " threads, grain " << grain;
    }
  }
}

TEST(ThreadTeam, AnErrorEndsTheLoopsOfAll) {
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    std::atomic<int> after = 0;
    const auto failing = [&] {
      parallel_region([&](ThreadTeam& team) {
        team.loop(100, 1, [](std::size_t i) {
          if (i == 50) throw std::runtime_error("item 50");
        });
        ++after;
      });
    };
    EXPECT_THROW(failing(), std::runtime_error);
    EXPECT_EQ(after, 0) << "nobody goes on from a loop that was not finished";
  }
}

TEST(ThreadTeam, InOneThreadsWorkItIsThatThread) {
  const ThreadLimit limit(4);
  std::atomic<int> strangers = 0;
  on_this_thread([&] {
    const auto mine = std::this_thread::get_id();
    parallel_region([&](ThreadTeam& team) {
      team.loop(500, 1, [&](std::size_t) { strangers += std::this_thread::get_id() != mine; });
    });
  });
  EXPECT_EQ(strangers, 0);
}

}  // namespace
