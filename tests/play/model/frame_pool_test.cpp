// Frames that are used again once nobody reads them.
#include "dreampm/play/model/frame_pool.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace dreampm::play::frame_pool_test {
namespace {

TEST(FramePool, GivesAFrameAgainOnlyOnceNobodyReadsIt) {
  FramePool pool;
  std::shared_ptr<Frame> written = pool.next();
  const Frame* const first = written.get();
  written->facts.reserve(100);
  std::shared_ptr<const Frame> read = std::exchange(written, nullptr), also = read;
  EXPECT_NE(pool.next().get(), first);
  read.reset();
  std::vector<std::shared_ptr<Frame>> others{pool.next(), pool.next()};
  for (const auto& other : others) EXPECT_NE(other.get(), first);
  also.reset();
  const std::shared_ptr<Frame> again = pool.next();
  EXPECT_EQ(again.get(), first);
  EXPECT_GE(again->facts.capacity(), 100u) << "its memory is still there";
}

TEST(FramePool, LetsGoOfTheOtherSideWithItsFrame) {
  FramePool a, b;
  std::shared_ptr<Frame> one = a.next(), other = b.next();
  const std::weak_ptr<Frame> watched = other;
  one->other = std::move(other);
  one.reset();
  EXPECT_TRUE(watched.expired());
}

TEST(FramePool, MayBeGoneBeforeItsFrames) {
  std::shared_ptr<Frame> frame;
  {
    FramePool pool;
    frame = pool.next();
  }
  frame->story = "late";
  EXPECT_EQ(frame->story, "late");
}

// A reader of each frame counts what was written; a frame that is written while it is read would
// show two numbers. Under ThreadSanitizer it would be a race.
TEST(FramePool, IsReadByOtherThreadsWhileItIsWritten) {
  FramePool pool;
  constexpr std::size_t rounds = 300, readers = 3;
  int torn = 0;
  for (std::size_t n = 0; n < rounds; ++n) {
    const std::shared_ptr<Frame> frame = pool.next();
    frame->values.assign(100, static_cast<double>(n));
    std::vector<std::thread> threads;
    std::vector<int> bad(readers);
    if (n % 30 == 0)
      for (std::size_t r = 0; r < readers; ++r)
        threads.emplace_back([&bad, r, read = std::shared_ptr<const Frame>(frame)]() mutable {
          bad[r] = std::set<double>(read->values.begin(), read->values.end()).size() != 1;
          read.reset();
        });
    pool.next()->values.assign(100, -1);
    for (std::thread& thread : threads) thread.join();
    for (const int b : bad) torn += b;
  }
  EXPECT_EQ(torn, 0);
}

}  // namespace
}  // namespace dreampm::play::frame_pool_test
