// A simulation that a program holds: time, observers, views, snapshots, threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "dreampm/backend/registry.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/run_record.h"
#include "dreampm/io/series.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/render.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;

TEST(Simulation, GivesTheBitsOfARunOfTheSameScene) {
  const auto folder = std::filesystem::temp_directory_path() / "dreampm_simulation_bits";
  std::filesystem::remove_all(folder);
  const Scene scene = dam_and_jelly();
  SimulateOptions options;
  options.folder = folder;
  options.frames = 4;
  simulate(scene.model(), {scene.file(), {}}, options);
  const RunRecord record = RunRecord::load(folder / "run.json");
  Simulation simulation(scene, quiet());
  std::vector<std::string> hashes;
  simulation.on_frame([&](const FrameEvent&) {
    Hash64 h;
    h.add(simulation.hash());
    hashes.push_back(h.hex());
  });
  simulation.advance_frames(3);
  ASSERT_EQ(record.frames.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(hashes.at(i), record.frames[i + 1].state_hash);
  std::filesystem::remove_all(folder);
}

TEST(Simulation, ProbesHaveTheRowsOfARunAndGoBackWithIt) {
  const auto folder = std::filesystem::temp_directory_path() / "dreampm_simulation_probes";
  std::filesystem::remove_all(folder);
  const Scene scene = dam_and_jelly().with({"probes.level={type: height, at: [0.1, 0.08]}",
                                            "probes.push={type: force, on: x_max, rate: 300}",
                                            "probes.fall={type: point, body: cube, at: [0.16, 0.08, 0.08]}"});
  SimulateOptions options;
  options.folder = folder;
  options.frames = 5;
  simulate(scene.model(), {scene.file(), {}}, options);
  for (const std::string backend : {"cpu", "reference"}) {
    Simulation simulation(scene, quiet(1, backend));
    EXPECT_EQ(simulation.probe("level").time, std::vector<double>{0});
    simulation.advance_frames(2);
    simulation.advance_steps(3);
    const Snapshot then = simulation.snapshot();
    const std::size_t rows = simulation.probe("push").rows.size();
    for (int turn = 0; turn < 2; ++turn) {
      simulation.restore(then);
      EXPECT_EQ(simulation.probe("push").rows.size(), rows) << "what came after is forgotten";
      simulation.advance_frames(2);
      for (const std::string name : {"level", "push", "fall"}) {
        const Series file = read_series(folder / "probes" / (name + ".csv"));
        const ProbeSeries& own = simulation.probe(name);
        EXPECT_EQ(own.columns, std::vector<std::string>(file.columns.begin() + 1, file.columns.end()));
        ASSERT_EQ(own.rows.size(), file.rows.size()) << name;
        EXPECT_EQ(own.time.size(), own.rows.size());
        if (backend != "cpu") continue;  // which the file is of
        for (std::size_t r = 0; r < file.rows.size(); ++r) {
          EXPECT_DOUBLE_EQ(own.time[r], file.rows[r][0]);
          for (std::size_t c = 0; c < own.columns.size(); ++c)
            EXPECT_DOUBLE_EQ(own.rows[r][c], file.rows[r][c + 1]) << name << ' ' << own.columns[c] << ' ' << r;
        }
      }
    }
  }
  Simulation other(dam_and_jelly(), quiet()), same(scene, quiet());
  const Snapshot without = other.snapshot();
  EXPECT_THROW(same.restore(without), InputError) << "it does not know what the probes remember";
  EXPECT_THAT(refusal([&] { same.probe("depth"); }),
              HasSubstr("probe depth is not in the scene; it has level, push, fall"));
  std::filesystem::remove_all(folder);
}

TEST(Simulation, TimeMovesByWholeStepsAndFramesEndExactly) {
  Simulation simulation(dam_and_jelly(), quiet());
  EXPECT_EQ(simulation.time(), 0);
  EXPECT_EQ(simulation.frame(), 1);
  const double dt = simulation.dt();
  const StepReport r = simulation.step();
  EXPECT_EQ(r.dt, dt);
  EXPECT_EQ(r.time, dt);
  EXPECT_EQ(r.step, 1u);
  simulation.advance_to(0.01);
  EXPECT_GE(simulation.time(), 0.01 - 1e-9);
  EXPECT_LT(simulation.time(), 0.01 + 2 * dt);
  simulation.advance_frames(1);
  EXPECT_DOUBLE_EQ(simulation.time(), 0.02);
  EXPECT_EQ(simulation.frame(), 2);
}

TEST(Simulation, ShowsParticlesInTheOrderOfTheirIds) {
  Simulation simulation(dam_and_jelly(), quiet());
  const ParticleView start = simulation.particles("water");
  ASSERT_EQ(start.size(), 4u * 6 * 8);
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_EQ(start.id[i], i);
    EXPECT_EQ(start.velocity[i].x, 0.5f);
    EXPECT_EQ(start.J[i], 1);
  }
  EXPECT_EQ(simulation.particles("jelly").id[0], start.size());
  const std::vector<Vec3f> from(start.position.begin(), start.position.end());
  const StepReport r = simulation.step();
  const ParticleView now = simulation.particles("water");
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_EQ(now.id[i], i);
    EXPECT_LT(length(now.position[i] - from[i] - now.velocity[i] * static_cast<float>(r.dt)), 2e-3 * 0.02);
  }
  EXPECT_THAT(refusal([&] { simulation.particles("watr"); }), HasSubstr("it has water, jelly"));
}

TEST(Simulation, AViewKeepsTheParticlesAsTheyWere) {
  auto simulation = std::make_unique<Simulation>(dam_and_jelly(), quiet());
  const ParticleView water = simulation->particles("water");
  const std::vector<Vec3f> from(water.position.begin(), water.position.end());
  const auto same = [&] { return std::equal(from.begin(), from.end(), water.position.begin(), water.position.end()); };
  EXPECT_EQ(simulation->particles("water").position.data(), water.position.data()) << "asked twice, gathered once";
  simulation->advance_steps(3);
  EXPECT_NE(simulation->particles("water").position[0], from[0]);
  EXPECT_TRUE(same());
  simulation->remove(Shape::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(same());
  simulation.reset();
  EXPECT_TRUE(same());
}

TEST(Simulation, ParticlesHaveTheColorOfTheirBody) {
  Simulation s(dam_and_jelly(), quiet());
  const auto color = [&](const char* material, std::size_t i) { return s.particles(material).color[i]; };
  const Vec3f water = color("water", 0), jelly = color("jelly", 0);
  EXPECT_GT(water.z, water.x) << "water is blue";
  const std::size_t count = s.particles("jelly").size();
  s.add({"red", "jelly", Shape::sphere({0.05, 0.16, 0.08}, 0.03), {}, {}, Vec3d{1, 0, 0}});
  EXPECT_EQ(color("jelly", count - 1), jelly);
  EXPECT_EQ(color("jelly", count), (Vec3f{1, 0, 0}));
}

TEST(Simulation, PicturesShowTheColorOfABodyThatWasAdded) {
  const auto reddish = [](const std::optional<Vec3d>& color) {
    Simulation s(dam_and_jelly().with({"render.looks.jelly={type: opaque, color: [0.5, 0.5, 0.5]}"}), quiet());
    s.remove(Shape::box({0, 0, 0}, {0.24, 0.2, 0.16}));
    s.add({"ball", "jelly", Shape::sphere({0.12, 0.1, 0.08}, 0.07), {}, {}, color});
    const RgbImage image = render(s, {.width = 64, .height = 36, .samples = 4});
    std::size_t count = 0;
    for (std::size_t p = 0; p < image.pixels.size(); p += 3) count += image.pixels[p] > 2 * image.pixels[p + 1];
    return count;
  };
  EXPECT_EQ(reddish({}), 0u);
  EXPECT_GT(reddish(Vec3d{0.9, 0.05, 0.05}), 50u);
}

TEST(Simulation, ATimeStepThatCannotWorkIsRefused) {
  const Scene scene = dam_and_jelly().with({"time.dt=0.05"});
  EXPECT_THAT(refusal([&] { Simulation(scene, quiet()); }), HasSubstr("time.dt is 0.05: must be at most"));
}

TEST(Simulation, ObserversSeeEveryStepAndFrame) {
  Simulation simulation(dam_and_jelly(), quiet());
  std::uint64_t steps = 0, in_frames = 0;
  std::vector<int> frames;
  simulation.on_step([&](const StepReport& r) {
    EXPECT_EQ(r.step, ++steps);
    EXPECT_EQ(r.time, simulation.time());
    EXPECT_GT(r.max_speed, 0);
  });
  simulation.on_frame([&](const FrameEvent& e) { frames.push_back(e.frame), in_frames += e.steps; });
  simulation.advance_frames(2);
  EXPECT_EQ(frames, (std::vector<int>{2, 3}));
  EXPECT_EQ(steps, simulation.steps());
  EXPECT_EQ(in_frames, steps);
}

TEST(Simulation, AnObserverThatThrowsLeavesTheStepWhole) {
  Simulation once(dam_and_jelly(), quiet()), interrupted(dam_and_jelly(), quiet());
  once.advance_frames(2);
  interrupted.on_step([](const StepReport& r) {
    if (r.step == 7) throw std::runtime_error("enough");
  });
  EXPECT_THROW(interrupted.advance_frames(2), std::runtime_error);
  EXPECT_EQ(interrupted.steps(), 7u);
  interrupted.advance_frames(2);
  EXPECT_EQ(interrupted.frame(), 3);
  EXPECT_EQ(interrupted.hash(), once.hash());
}

TEST(Simulation, GoesBackToASnapshotBitByBit) {
  for (const std::string& backend : backends_here()) {
    Simulation simulation(dam_and_jelly("asflip"), quiet(1, backend));
    simulation.advance_to(0.015);
    const Snapshot then = simulation.snapshot();
    EXPECT_EQ(then.time(), simulation.time());
    EXPECT_GT(then.bytes(), 100u * simulation.particle_count());
    const auto here = simulation.hash();
    const float x = simulation.particles("water").position[5].x;
    simulation.advance_frames(2);
    const auto future = simulation.hash();
    simulation.restore(then);
    EXPECT_EQ(simulation.hash(), here);
    EXPECT_EQ(simulation.particles("water").position[5].x, x);
    simulation.advance_frames(2);
    EXPECT_EQ(simulation.hash(), future) << backend;
    Simulation another(dam_and_jelly("asflip"), quiet(1, backend));
    another.restore(then);
    another.advance_frames(2);
    EXPECT_EQ(another.hash(), future) << backend;
  }
}

TEST(Simulation, RefusesWhatIsNotItsOwn) {
  Simulation a(dam_and_jelly(), quiet()), b(dam_and_jelly("asflip"), quiet()),
      c(dam_and_jelly(), quiet(1, "reference"));
  EXPECT_THAT(refusal([&] { a.restore(b.snapshot()); }), HasSubstr("another scene"));
  EXPECT_THAT(refusal([&] { a.restore(c.snapshot()); }), HasSubstr("backend"));
  EXPECT_TRUE(Snapshot().empty());
  EXPECT_EQ(Snapshot().time(), 0);
  EXPECT_EQ(Snapshot().bytes(), 0u);
  EXPECT_THAT(refusal([&] { a.restore(Snapshot()); }), HasSubstr("another scene"));
  EXPECT_THAT(refusal([] { Simulation(dam_and_jelly(), quiet(1, "gpu")); }),
              HasSubstr("backend gpu is not known; there are cpu, reference"));
  EXPECT_THAT(refusal([&] { a.advance_frames(-1); }), HasSubstr("0 or more"));
  EXPECT_THAT(refusal([&] { a.advance_to(std::nan("")); }), HasSubstr("must be a number"));
  EXPECT_THAT(refusal([&] { a.advance_to(HUGE_VAL); }), HasSubstr("must be a number"));
  EXPECT_THAT(refusal([&] { a.particle_count("nothing"); }), HasSubstr("nothing"));
  EXPECT_THAT(refusal([] { load_scene("nowhere.yaml"); }), HasSubstr("nowhere.yaml"));
}

TEST(Simulation, AHostHearsAndStops) {
  ListeningHost host;
  SimulationOptions options;
  options.host = &host;
  Simulation simulation(dam_and_jelly(), options);
  ASSERT_FALSE(host.infos.empty());
  EXPECT_THAT(host.infos[0], HasSubstr("bulk modulus"));
  simulation.on_step([&](const StepReport& r) { host.stop = r.step == 3; });
  EXPECT_THROW(simulation.advance_frames(1), Interrupted);
  EXPECT_EQ(simulation.steps(), 3u);
  host.stop = false;
  simulation.advance_frames(1);
  EXPECT_EQ(simulation.frame(), 2);
}

TEST(Simulation, SeveralRunSideBySide) {
  const auto course = [](int threads, int* lines) {
    ListeningHost host;
    SimulationOptions options;
    options.threads = threads, options.host = &host;
    Simulation simulation(dam_and_jelly(), options);
    simulation.advance_frames(3);
    *lines = static_cast<int>(host.infos.size());
    return simulation.hash();
  };
  const ThreadLimit three(3);  // however many cores there are
  int lines = 0;
  const auto alone = course(1, &lines);
  std::array<std::uint64_t, 3> hashes{};
  std::array<int, 3> heard{};
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&, i] { hashes[std::size_t(i)] = course(1 + i, &heard[std::size_t(i)]); });
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(hashes[i], alone);
    EXPECT_EQ(heard[i], lines) << "lines of one went to another";
  }
}

TEST(Simulation, MakesSurfacesAndPictures) {
  Simulation simulation(dam_and_jelly(), quiet());
  const TriMesh mesh = simulation.surface("water", {.overlap = 0});
  ASSERT_GT(mesh.triangles.size(), 100u);
  double volume = 0;
  for (const auto& t : mesh.triangles)
    volume += dot(static_cast<Vec3d>(mesh.vertices[t[0]]),
                  cross(static_cast<Vec3d>(mesh.vertices[t[1]]), static_cast<Vec3d>(mesh.vertices[t[2]]))) /
              6;
  EXPECT_NEAR(volume, 0.08 * 0.12 * 0.16, 0.08 * 0.08 * 0.12 * 0.16);
  EXPECT_THAT(refusal([&] { simulation.surface("water", {.voxel = 5}); }), HasSubstr("voxel"));
  const RgbImage image = render(simulation, {.width = 32, .height = 18, .samples = 4});
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.pixels.size(), 32u * 18 * 3);
  EXPECT_NE(*std::max_element(image.pixels.begin(), image.pixels.end()),
            *std::min_element(image.pixels.begin(), image.pixels.end()));
}

TEST(Scene, ReadsBackWhatItWrites) {
  const Scene scene = dam_and_jelly();
  EXPECT_EQ(scene.name(), "dam");
  EXPECT_EQ(scene.materials(), (std::vector<std::string>{"water", "jelly"}));
  EXPECT_EQ(scene.fps(), 50);
  EXPECT_EQ(parse_scene(scene.yaml(), "again").yaml(), scene.yaml());
  const Scene finer = scene.with({"space.spacing=0.01"});
  EXPECT_EQ(finer.spacing(), 0.01);
  EXPECT_EQ(scene.spacing(), 0.02);
  EXPECT_THAT(refusal([&] { scene.with({"space.spacin=0.01"}); }), HasSubstr("did you mean 'spacing'"));
}

}  // namespace
}  // namespace dreampm
