// What is poured and dropped: how much of it comes, and how densely it lies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "dreampm/play/model/matter.h"
#include "dreampm/surface/volume_taken.h"
#include "play/small_scene.h"

namespace dreampm::play::poured_test {
namespace {
using namespace test;
using testing::HasSubstr;

TEST(Playground, PouringFillsAtTheDensityOfRestAndNothingIsBornInMatter) {
  Playground p(small_scene(), quiet_options());
  play(p, {"erase 0.2 0.2 0.12 0.5", "set matter 0", "pour 0.2 0.3 0.12 0.06 0 -1.5 0", "frames 20", "pour off"});
  const std::shared_ptr<const Frame> frame = p.frame();
  // What a jet of that width and speed brings in a third of a second.
  const double volume = static_cast<double>(frame->particles) * std::pow(0.02, 3);
  EXPECT_NEAR(volume, M_PI * 0.06 * 0.06 * 1.5 / 3, 0.1 * M_PI * 0.06 * 0.06 * 1.5 / 3);
  // Where it stands already nothing more comes.
  play(p, {"pour 0.2 0.02 0.12 0.05 0 -1.5 0", "frames 4", "pour off", "frames 60"});
  EXPECT_TRUE(finite(*p.frame()));
  // A full tank takes no more.
  Playground full(small_scene(), quiet_options());
  PlayOptions few = quiet_options();
  few.most_particles = full.simulation().particle_count() + 50;
  Playground limited(small_scene(), few);
  play(limited, {"pour 0.2 0.3 0.12 0.03 0 -1.5 0", "frames 60"});
  EXPECT_LE(limited.simulation().particle_count(), few.most_particles);
  EXPECT_THAT(limited.frame()->message, HasSubstr("are the most"));
}

// At half the pace the jet brings half as much: it is as dense, and not twice.
TEST(Playground, AJetIsAsDenseWhereTheWorldIsSlowerThanAsked) {
  const auto poured = [](const Playground::Limit& limit) {
    Playground p(small_scene(), quiet_options());
    const std::size_t before = p.simulation().particle_count();
    p.act(Action::parse("pour 0.2 0.35 0.12 0.07 0 -1.5 0"));
    while (p.simulation().time() < 0.15) p.tick(limit);
    return static_cast<double>(p.simulation().particle_count() - before);
  };
  const double full = poured({});
  EXPECT_NEAR(poured({2, {}}), full, 0.2 * full);
}

// What falls faster is thinner, and as dense: nothing else brings a liquid together again.
TEST(Playground, AJetThatGravityDrawsOutBecomesThinner) {
  Playground p(small_scene(), quiet_options());
  play(p, {"erase 0.2 0.2 0.12 0.5", "pour 0.2 0.36 0.12 0.06 0 -1.5 0", "frames 14"});
  const ParticleView water = p.simulation().particles("water");
  // In slices of the free jet: as a round bar of the second moments of what is there.
  constexpr double high = 0.05, full = 8e-6;
  for (const double low : {0.15, 0.2, 0.25}) {
    double n = 0, xx = 0, zz = 0;
    Vec3d middle{};
    for (int turn = 0; turn < 2; ++turn)
      for (const Vec3f& x : water.position) {
        const Vec3d at = static_cast<Vec3d>(x);
        if (at.y < low || at.y >= low + high) continue;
        if (turn == 0)
          ++n, middle = middle + at;
        else
          xx += std::pow(at.x - middle.x / n, 2), zz += std::pow(at.z - middle.z / n, 2);
      }
    const double area = 4 * M_PI * std::sqrt(xx * zz) / n;
    EXPECT_NEAR(n * full / (area * high), 1, 0.2) << low;
  }
}

// Poured paste that has sunk together is as dense as paste at rest, by what its particles believe
// and by how they lie.
TEST(Playground, PouredToothpasteTakesItsRestVolume) {
  Playground p(small_scene(), quiet_options());
  play(p, {"erase 0.2 0.2 0.12 0.5", "set matter 8", "pour 0.2 0.33 0.12 0.06 0 -1.5 0", "frames 30", "pour off",
           "frames 160"});
  const ParticleView paste = p.simulation().particles("toothpaste");
  ASSERT_GT(paste.size(), 800u);
  double believed = 0;
  for (const float j : paste.J) believed += static_cast<double>(j) / static_cast<double>(paste.size());
  const double taken = volume_taken({.positions = paste.position,
                                     .spacing = 0.02f,
                                     .walls = {{0, 0, 0}, {0.4f, 0.4f, 0.24f}},
                                     .is_wall = {true, true, true, true, true, true}}) /
                       (static_cast<double>(paste.size()) * 8e-6);
  std::printf("%zu particles take %.3f of their rest volume, and believe %.3f\n", paste.size(), taken, believed);
  EXPECT_NEAR(taken, 1, 0.05);
  EXPECT_NEAR(believed, 1, 0.05);
}

TEST(Playground, EveryKindOfMatterCanBePouredAndDropped) {
  for (std::size_t kind = 0; kind < matters().size(); ++kind) {
    Playground p(small_scene(), quiet_options());
    const std::size_t before = p.simulation().particle_count();
    play(p, {"set matter " + std::to_string(kind), "drop box 0.2 0.3 0.12 0.1", "frames 10"});
    EXPECT_GT(p.simulation().particle_count(), before + 50) << matters()[kind].title;
    EXPECT_TRUE(finite(*p.frame())) << matters()[kind].title;
    EXPECT_EQ(p.frame()->message, "") << matters()[kind].title;
  }
}

}  // namespace
}  // namespace dreampm::play::poured_test
