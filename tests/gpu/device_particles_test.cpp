// Particles as arrays on a device, as a program asks a Simulation for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include <simulation/scenes.h>

namespace dreampm {
namespace {
using namespace test;
using testing::AllOf;
using testing::HasSubstr;

template <class T>
std::vector<T> downloaded(const std::shared_ptr<const DeviceArray>& array, std::size_t count) {
  EXPECT_EQ(array->bytes(), count * sizeof(T));
  EXPECT_EQ(array->data() == nullptr, count == 0);
  EXPECT_EQ(array->device(), DeviceId());
  std::vector<T> all(count);
  array->download(all.data());
  return all;
}

/// Particles by their ids.
struct Particle {
  Vec3f position, velocity;
  bool operator==(const Particle&) const = default;
};
using Particles = std::map<std::uint32_t, Particle>;

Particles on_device(const DeviceParticles& p) {
  const auto position = downloaded<Vec3f>(p.position, p.size()), velocity = downloaded<Vec3f>(p.velocity, p.size());
  const auto id = downloaded<std::uint32_t>(p.id, p.size());
  Particles all;
  for (std::size_t i = 0; i < p.size(); ++i) all[id[i]] = {position[i], velocity[i]};
  EXPECT_EQ(all.size(), p.size());
  return all;
}
Particles on_host(const ParticleView& p) {
  Particles all;
  for (std::size_t i = 0; i < p.size(); ++i) all[p.id[i]] = {p.position[i], p.velocity[i]};
  return all;
}

void expect_the_same(const Simulation& s, const char* when) {
  for (const std::string& material : s.names().materials) {
    // Before the host asks for them, and after.
    const Particles got = on_device(s.device_particles(material));
    EXPECT_EQ(got, on_host(s.particles(material))) << when << ": " << material;
    EXPECT_EQ(got, on_device(s.device_particles(material))) << when << ": " << material;
  }
}

// At the start, after steps, and after edits, whose velocities the host has changed.
TEST(DeviceParticles, AreThoseOfTheHost) {
  Simulation s(dam_and_jelly("asflip"), quiet(1, "gpu"));
  expect_the_same(s, "at the start");
  script(s, [&](int step) {
    if (step % 5 == 0 || step > 40) expect_the_same(s, ("step " + std::to_string(step)).c_str());
  });
  s.advance_frames(1);
  expect_the_same(s, "after a frame");
  const Snapshot then = s.snapshot();
  s.advance_steps(7);
  expect_the_same(s, "after some steps");
  s.restore(then);
  expect_the_same(s, "restored");
  s.remove(Shape::box({0, 0, 0}, {0.24, 0.2, 0.16}));
  expect_the_same(s, "without particles");
}

TEST(DeviceParticles, LieWithinAPeriodicBox) {
  const Scene scene = parse_scene(
      "dreampm: 1\nname: round\nspace: {min: [-0.1, 0, 0], max: [0.22, 0.16, 0.16], spacing: 0.01, periodic: [x]}\n"
      "time: {fps: 50}\nmaterials: {snow: {type: snow}}\n"
      "bodies: {ball: {material: snow, shape: {sphere: {radius: 0.05}, center: [0.16, 0.09, 0.08]}, velocity: [3, 0, "
      "0]}}\n",
      "round.yaml");
  Simulation s(scene, quiet(1, "gpu"));
  s.advance_to(0.03);
  expect_the_same(s, "half around");
  const auto all = downloaded<Vec3f>(s.device_particles("snow").position, s.particle_count());
  const auto [low, high] =
      std::minmax_element(all.begin(), all.end(), [](const Vec3f& a, const Vec3f& b) { return a.x < b.x; });
  EXPECT_GE(low->x, -0.1f);
  EXPECT_LT(low->x, -0.05f);
  EXPECT_LE(high->x, 0.22f);
  EXPECT_GT(high->x, 0.17f);
}

TEST(DeviceParticles, AskingChangesNoBit) {
  Simulation asked(dam_and_jelly(), quiet(1, "gpu")), alone(dam_and_jelly(), quiet(1, "gpu"));
  for (int i = 0; i < 10; ++i) {
    asked.advance_steps(4), alone.advance_steps(4);
    asked.device_particles("water"), asked.device_particles("jelly", {false, true, false});
  }
  EXPECT_EQ(asked.hash(), alone.hash());
}

TEST(DeviceParticles, StayAsTheyWereEvenWithoutTheSimulation) {
  DeviceParticles then;
  Particles want;
  std::shared_ptr<const DeviceArray> copied;
  {
    Simulation s(dam_and_jelly(), quiet(1, "gpu"));
    s.advance_frames(1);
    then = s.device_particles("water"), want = on_host(s.particles("water"));
    copied = then.position->copy();
    s.advance_frames(1);
  }
  EXPECT_EQ(on_device(then), want);
  EXPECT_NE(copied->data(), then.position->data());
  EXPECT_EQ(downloaded<Vec3f>(copied, then.size()), downloaded<Vec3f>(then.position, then.size()));
}

TEST(DeviceParticles, WhatIsNotAskedForIsNotThere) {
  Simulation s(dam_and_jelly(), quiet(1, "gpu"));
  const DeviceParticles some = s.device_particles("water", {true, false, false});
  EXPECT_TRUE(some.position);
  EXPECT_FALSE(some.velocity);
  EXPECT_FALSE(some.id);
}

TEST(DeviceParticles, SaysWhereThereAreNone) {
  Simulation cpu(dam_and_jelly(), quiet()), gpu(dam_and_jelly(), quiet(1, "gpu"));
  EXPECT_THAT(refusal([&] { cpu.device_particles("water"); }),
              AllOf(HasSubstr("backend cpu keeps particles in the host's memory"), HasSubstr("cuda")));
  EXPECT_THAT(refusal([&] { gpu.device_particles("watr"); }), HasSubstr("it has water, jelly"));
  const Scene projected = parse_scene(
      "dreampm: 1\nname: pool\nspace: {min: [0, 0, 0], max: [0.2, 0.1, 0.1], spacing: 0.02}\n"
      "time: {fps: 50, solver: projection}\nmaterials: {water: {type: newtonian}}\n"
      "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.1, 0.06, 0.1]}}}}\n",
      "pool.yaml");
  Simulation projection(projected, quiet(1, "gpu"));
  EXPECT_THAT(refusal([&] { projection.device_particles("water"); }), HasSubstr("projection"));
}

/// Stops after some steps.
class StoppingHost final : public Host {
 public:
  void info(const std::string&) override {}
  void warning(const std::string&) override {}
  bool stop_requested() override { return steps-- == 0; }
  int steps = -1;
};

TEST(DeviceParticles, VelocitiesOfABrokenCallAreNotMadeUp) {
  StoppingHost host;
  SimulationOptions options = quiet(1, "gpu");
  options.host = &host;
  Simulation s(dam_and_jelly(), options);
  host.steps = 2;
  EXPECT_THROW(s.advance_frames(1), Interrupted);
  EXPECT_THROW(s.device_particles("water"), RunError);
  EXPECT_EQ(s.device_particles("water", {true, false, true}).size(), s.particle_count("water"));
  s.step();
  expect_the_same(s, "after one more step");
}

}  // namespace
}  // namespace dreampm
