// Several worlds that step at the same time, each on its own threads.
#include <gtest/gtest.h>

#include <thread>

#include "dreampm/base/host.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "mixed_world.h"

namespace dreampm::side_by_side_test {
namespace {
using namespace test;

class CountingHost final : public Host {
 public:
  void info(const std::string&) override { ++lines; }
  void warning(const std::string&) override { ++lines; }
  int lines = 0;
};

TEST(SideBySide, WorldsGiveTheBitsThatTheyGiveAlone) {
  const ThreadLimit four(4);  // however many cores there are
  const auto course = [](int threads, const char* material, std::uint64_t& hash, int& lines) {
    CountingHost host;
    ThreadArena(threads).run([&] {
      const HostScope scope(&host);
      info("{} begins", material);
      hash = state_hash(ran<float>(material, *make_cpu_backend(), 20));
    });
    lines = host.lines;
  };
  constexpr std::array<const char*, 4> materials{"newtonian", "elastic", "newtonian", "snow"};
  std::array<std::uint64_t, 4> alone{}, together{};
  std::array<int, 4> lines{};
  for (std::size_t i = 0; i < 4; ++i) course(1, materials[i], alone[i], lines[i]);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i)
    threads.emplace_back([&, i] { course(1 + static_cast<int>(i % 3), materials[i], together[i], lines[i]); });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(together, alone);
  for (const int n : lines) EXPECT_EQ(n, 1) << "a line of one went to another";
}

}  // namespace
}  // namespace dreampm::side_by_side_test
