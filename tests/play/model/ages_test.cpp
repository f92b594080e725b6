#include "dreampm/play/model/ages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dreampm/play/panels/panels.h"
#include "play/small_scene.h"

namespace dreampm::play::ages_test {
namespace {
using namespace test;

std::vector<float> ages_of(Playground& p, std::size_t material) {
  std::vector<float> ages = p.frame()->matter.at(material).value;
  std::sort(ages.begin(), ages.end());
  return ages;
}

TEST(Ages, CountFromWhenMatterCameIn) {
  Playground p(small_scene(), quiet_options());
  play(p, {"set color_by 5", "frames 6"});
  EXPECT_EQ(p.frame()->value_label, "age");
  EXPECT_EQ(p.frame()->value_unit, "s");
  const auto now = [&] { return static_cast<float>(p.simulation().time()); };
  for (const float age : ages_of(p, 0)) EXPECT_FLOAT_EQ(age, now()) << "what was there at the start";
  play(p, {"pour 0.2 0.3 0.12 0.04 0 -1.5 0", "frames 12", "pour off", "frames 6"});
  const std::vector<float> ages = ages_of(p, 0);
  EXPECT_FLOAT_EQ(ages.back(), now());
  EXPECT_NEAR(ages.front(), 6.0 / 60, 1.5 / 60) << "what was poured last";
  EXPECT_EQ(p.frame()->value_min, 0);
  // What is undone never was: its ids are given again.
  play(p, {"undo", "frames 30", "drop sphere 0.2 0.3 0.12 0.06", "frames 3"});
  EXPECT_NEAR(ages_of(p, 0).front(), 3.0 / 60, 1.5 / 60);
  play(p, {"restart", "frames 2"});
  for (const float age : ages_of(p, 0)) EXPECT_FLOAT_EQ(age, now());
}

TEST(Ages, OfIdsThatAreGivenAgain) {
  Ages ages;
  const std::vector<std::uint32_t> first{0, 3}, second{0, 3, 4};
  ages.see(first, 1), ages.see(second, 2);
  EXPECT_FLOAT_EQ(ages.age(3, 5), 4);
  EXPECT_FLOAT_EQ(ages.age(4, 5), 3);
  ages.back_to(1.5);
  ages.see(second, 1.6);
  EXPECT_FLOAT_EQ(ages.age(0, 5), 4);
  EXPECT_FLOAT_EQ(ages.age(4, 5), 3.4f);
  EXPECT_EQ(ages.age(77, 5), 0) << "never seen";
}

TEST(RoundLength, IsTheLargestThatFits) {
  const auto text = [](double most) { return round_length(most).text; };
  EXPECT_EQ(text(0.37), "20 cm");
  EXPECT_EQ(text(0.5), "50 cm");
  EXPECT_EQ(text(0.0999), "5 cm");
  EXPECT_EQ(text(1), "1 m");
  EXPECT_EQ(text(73), "50 m");
  EXPECT_EQ(text(0.0031), "2 mm");
  EXPECT_EQ(text(0.012), "1 cm");
  for (double most = 1e-4; most < 1e3; most *= 1.37) {
    EXPECT_LE(round_length(most).meters, most * (1 + 1e-6));
    EXPECT_GT(round_length(most).meters, most / 2.6);
  }
}

}  // namespace
}  // namespace dreampm::play::ages_test
