// A backend whose matter lies elsewhere gives the same runs: whatever reads particles and nodes
// asks for them before, and sums come from the backend.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/host.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
namespace fs = std::filesystem;

/// Water runs out of an open wall, under jelly that keeps velocities.
constexpr const char* outflow = R"(dreampm: 1
name: outflow
space: {min: [0, 0, 0], max: [0.24, 0.2, 0.16], spacing: 0.02, walls: {x_max: {type: open}}}
time: {fps: 50, frames: 8}
materials:
  water: {type: newtonian, preset: water}
  jelly: {type: neo_hookean, density: 500, youngs_modulus: 2.0e4, poissons_ratio: 0.3, transfer: asflip}
bodies:
  dam: {material: water, shape: {box: {min: [0.16, 0, 0], max: [0.24, 0.12, 0.16]}}, velocity: [4, 0, 0]}
  cube: {material: jelly, shape: {box: {min: [0.04, 0.04, 0.04], max: [0.12, 0.12, 0.12]}}, spin: [0, 0, 3]}
output: {particles: {attributes: [velocity, j, density, pressure, jp, f]}, checkpoint: {every: 4}}
)";
constexpr const char* probe_of_every_type = R"(probes:
  level: {type: height, at: [0.2, 0.08]}
  push: {type: pressure, at: [0.2, 0, 0.08], normal: [0, 1, 0], radius: 0.05, rate: 120}
  flow: {type: velocity, at: [0.2, 0.05, 0.08], radius: 0.05}
  out: {type: flux, plane: {point: [0.22, 0, 0], normal: [1, 0, 0]}, rate: 200}
  part: {type: region, shape: {box: {min: [0.1, 0, 0], max: [0.24, 0.1, 0.16]}}}
  weight: {type: force, on: floor}
  width: {type: extent, axis: x, material: jelly}
  corner: {type: point, body: cube, at: [0.08, 0.08, 0.08]}
)";

/// Taps, one of which fills itself round a periodic axis, over a pool with a drain: what is in the
/// way of new matter is asked for before each batch.
constexpr const char* through_flow = R"(dreampm: 1
name: through-flow
space: {min: [0, 0, 0], max: [0.24, 0.2, 0.16], spacing: 0.02, periodic: [z]}
time: {fps: 50, frames: 8}
materials:
  water: {type: newtonian, preset: water}
  jelly: {type: neo_hookean, density: 500, youngs_modulus: 2.0e4, poissons_ratio: 0.3, transfer: asflip}
bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.24, 0.06, 0.16]}}}}
emitters:
  tap: {material: water, shape: {cylinder: {radius: 0.03, height: 0.02}, center: [0.06, 0.15, 0.03]}, velocity: [0, -1, 0], pool: 4000}
  slow: {material: jelly, shape: {box: {size: [0.06, 0.02, 0.06]}, center: [0.18, 0.12, 0.08]}, velocity: [0, -0.3, 0], pool: 4000}
  round: {material: water, shape: {box: {size: [0.04, 0.04, 0.02]}, center: [0.06, 0.1, 0.1]}, velocity: [0, 0, 1], pool: 4000}
sinks: {drain: {shape: {box: {min: [0.1, 0, 0], max: [0.2, 0.03, 0.16]}}}}
output: {particles: {attributes: [velocity, j]}, checkpoint: {every: 4}}
)";

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The files that a run writes of its matter.
struct Written {
  std::map<std::string, std::string> files;
  std::vector<std::string> hashes;
  std::uint64_t left = 0;
};

/// Wants to stop after that number of steps, without a word.
class StoppingHost final : public Host {
 public:
  explicit StoppingHost(int steps) : steps_(steps) {}
  void info(const std::string&) override {}
  void warning(const std::string&) override {}
  bool stop_requested() override { return steps_-- == 0; }

 private:
  int steps_;
};

/// Stops within a frame and goes on from there.
Written run(const std::string& scene_text, const std::string& backend) {
  const auto parsed = scene::parse_scene_text(scene_text, "outflow.yaml", {});
  if (!parsed.ok()) throw std::runtime_error(parsed.text());
  const fs::path folder =
      fs::path(DM_BINARY_DIR) / "test-files" / "away" / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  SimulateOptions options;
  options.folder = folder, options.backend = backend;
  StoppingHost host(50);
  const HostScope scope(&host);
  EXPECT_THROW(simulate(parsed.scene, {"outflow.yaml", {}}, options), Interrupted);
  options.resume = true;
  simulate(parsed.scene, {"outflow.yaml", {}}, options);
  Written all;
  all.files["ledger.csv"] = bytes_of(folder / "ledger.csv");
  for (const char* part : {"particles", "probes"})
    if (fs::exists(folder / part))
      for (const auto& file : fs::directory_iterator(folder / part))
        all.files[file.path().filename()] = bytes_of(file.path());
  for (const FrameRecord& f : RunRecord::load(folder / "run.json").frames)
    all.hashes.push_back(f.state_hash), all.left = f.left;
  return all;
}

TEST(Away, ARunWritesTheSameFiles) {
  for (const std::string backend : {"cpu", "reference"})
    // Without probes nothing is downloaded before a row of the ledger.
    for (const std::string probes : {"", probe_of_every_type}) {
      SCOPED_TRACE(backend + (probes.empty() ? "" : " with probes"));
      const Written plain = run(outflow + probes, backend), away = run(outflow + probes, backend + ", away");
      EXPECT_GT(plain.left, 0u) << "the momentum on the grid is asked for where matter leaves";
      EXPECT_EQ(plain.files.size(), 1u + 8 + (probes.empty() ? 0 : 8));
      EXPECT_EQ(away.hashes, plain.hashes);
      for (const auto& [name, bytes] : plain.files) EXPECT_TRUE(away.files.at(name) == bytes) << name;
    }
}

TEST(Away, MatterComesAndGoesTheSame) {
  for (const std::string backend : {"cpu", "reference"}) {
    SCOPED_TRACE(backend);
    const Written plain = run(through_flow, backend), away = run(through_flow, backend + ", away");
    EXPECT_GT(plain.left, 0u);
    EXPECT_EQ(away.hashes, plain.hashes);
    for (const auto& [name, bytes] : plain.files) EXPECT_TRUE(away.files.at(name) == bytes) << name;
  }
}

/// The state that a program sees of a simulation with every kind of edit, in turns, so that each
/// reader is once the first after a step or an edit.
struct Seen {
  std::vector<std::uint64_t> hashes;
  std::vector<double> totals;
  std::vector<std::vector<Vec3f>> positions, velocities, surfaces;
  std::vector<std::vector<Vec3d>> visited;
  std::vector<std::vector<float>> attributes;
};

Seen edited(const std::string& backend) {
  Simulation s(dam_and_jelly("asflip"), quiet(2, backend));
  Seen seen;
  script(s, [&](int step) {
    const auto add_totals = [&] {
      const Totals t = s.totals();
      seen.totals.insert(seen.totals.end(), {t.kinetic, t.elastic, t.momentum.x});
    };
    if (step % 5 == 0) add_totals();
    if (step % 10 == 5) s.dt();  // the edit of this step has acted then
    if (step % 5 == 1 || step % 10 == 5)
      for (const char* material : {"water", "jelly"}) {
        const ParticleView particles = s.particles(material);
        seen.positions.emplace_back(particles.position.begin(), particles.position.end());
        seen.velocities.emplace_back(particles.velocity.begin(), particles.velocity.end());
      }
    if (step % 5 == 2) seen.hashes.push_back(s.hash());
    if (step % 5 == 3) seen.surfaces.push_back(s.surface("water").vertices);
    if (step % 10 == 4) {
      std::vector<Vec3d>& all = seen.visited.emplace_back();
      s.visit("jelly", {.velocity = true}, [&](const ParticleBatch& some) {
        all.insert(all.end(), some.position.begin(), some.position.end());
        all.insert(all.end(), some.velocity.begin(), some.velocity.end());
      });
    }
    if (step % 10 == 9) {
      const AttributeView f = s.attribute("jelly", "f");
      seen.attributes.emplace_back(f.values.begin(), f.values.end());
    }
    if (step % 20 == 4) {
      const Snapshot then = s.snapshot();
      s.step();
      s.restore(then);
      add_totals();
    }
  });
  seen.hashes.push_back(s.hash());
  return seen;
}

TEST(Away, EditsViewsAndSnapshotsAreTheSame) {
  for (const std::string backend : {"cpu", "reference"}) {
    SCOPED_TRACE(backend);
    const Seen plain = edited(backend), away = edited(backend + ", away");
    EXPECT_EQ(away.hashes, plain.hashes);
    EXPECT_EQ(away.totals, plain.totals);
    EXPECT_EQ(away.positions, plain.positions);
    EXPECT_EQ(away.velocities, plain.velocities);
    EXPECT_EQ(away.surfaces, plain.surfaces);
    EXPECT_EQ(away.visited, plain.visited);
    EXPECT_EQ(away.attributes, plain.attributes);
  }
}

}  // namespace
}  // namespace dreampm
