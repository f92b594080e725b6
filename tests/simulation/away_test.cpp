// A backend whose matter lies elsewhere gives the same run: whatever reads particles and nodes asks
// for them before, and sums come from the backend.
#include <gtest/gtest.h>
#include <solver/away.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "dreampm/backend/registry.h"
#include "dreampm/pipeline/ledger_row.h"
#include "dreampm/pipeline/probes.h"
#include "dreampm/scene/parse.h"
#include "dreampm/simulation/assemble.h"
#include "dreampm/simulation/engine.h"
#include "dreampm/simulation/frames.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

/// Water runs out of an open wall, under jelly that keeps velocities; a probe of every kind.
constexpr const char* outflow = R"(dreampm: 1
name: outflow
space: {min: [0, 0, 0], max: [0.24, 0.2, 0.16], spacing: 0.02, walls: {x_max: {type: open}}}
time: {fps: 50, frames: 8}
materials:
  water: {type: newtonian, preset: water}
  jelly: {type: neo_hookean, density: 500, youngs_modulus: 2.0e4, poissons_ratio: 0.3, transfer: asflip}
bodies:
  dam: {material: water, shape: {box: {min: [0.16, 0, 0], max: [0.24, 0.12, 0.16]}}, velocity: [4, 0, 0]}
  cube: {material: jelly, shape: {box: {min: [0.04, 0.04, 0.04], max: [0.12, 0.12, 0.12]}}}
probes:
  level: {type: height, at: [0.2, 0.08]}
  push: {type: pressure, at: [0.2, 0, 0.08], normal: [0, 1, 0], radius: 0.05, rate: 120}
  flow: {type: velocity, at: [0.2, 0.05, 0.08], radius: 0.05}
  out: {type: flux, plane: {point: [0.22, 0, 0], normal: [1, 0, 0]}, rate: 200}
  part: {type: region, shape: {box: {min: [0.1, 0, 0], max: [0.24, 0.1, 0.16]}}}
  weight: {type: force, on: floor}
  width: {type: extent, axis: x, material: jelly}
  corner: {type: point, body: cube, at: [0.08, 0.08, 0.08]}
)";

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// What a run writes of its frames.
struct Seen {
  std::vector<std::map<std::string, double>> rows;
  std::vector<ParticleFrame> frames;
  std::vector<std::uint64_t> hashes;
  std::map<std::string, std::string> probes;
  std::uint64_t left = 0;
};

/// Runs the scene as the simulate stage does, with an edit in the middle.
template <class R>
class WatchedRun final : Observer<R> {
 public:
  WatchedRun(const SceneDescription& scene, std::unique_ptr<Backend<R>> backend, const fs::path& folder)
      : start_(assemble(scene, "outflow.yaml")),
        engine_(as_world<R>(start_.world), std::move(backend)),
        probes_(scene, start_, "outflow.yaml", folder) {
    engine_.add(*this);
    engine_.begin(start_.seeds);
    probes_.begin();
    add_row();
    look(true);
    on_frame();
  }
  Seen go(int frames) {
    const auto until = [&](int frame) {
      engine_.advance([&] { return engine_.world().frame >= frame; }, [](const World<R>&) { return false; });
    };
    until(frames / 2);
    engine_.world().gravity = {-3, -9, 1};
    engine_.form_grid();
    until(frames);
    seen_.left = engine_.world().left;
    return std::move(seen_);
  }

 private:
  double next_sample_time() const override { return probes_.next(); }
  void on_step(const StepSums& step) override {
    sums_.add(step, 1);
    probes_.accumulate(step);
    if (step.frame_done) add_row();
    look(step.frame_done);
  }
  void on_frame() override {
    engine_.download(MatterFields::particles);
    seen_.frames.push_back(particle_frame(engine_.world(), engine_.motion(), start_.bodies,
                                          {"velocity", "j", "density", "pressure", "f", "jp"}, {}));
    engine_.download(MatterFields::all);
    seen_.hashes.push_back(state_hash(engine_.world()));
  }
  /// Before anything of the step is downloaded: it needs none.
  void add_row() {
    seen_.rows.push_back(
        ledger_row(engine_.world(), engine_.backend(), engine_.motion(), std::exchange(sums_, {}), nullptr).values);
  }
  void look(bool frame_done) {
    engine_.download(probes_.fields_due(engine_.world().time, frame_done));
    probes_.look(engine_.world(), engine_.motion(), frame_done);
  }

  InitialState start_;
  Engine<R> engine_;
  ProbeSet<R> probes_;
  FrameSums sums_;
  Seen seen_;
};

void expect_the_same(const Seen& plain, const Seen& away) {
  ASSERT_GT(plain.left, 0u) << "matter has to leave: the momentum on the grid is asked for then";
  EXPECT_EQ(away.left, plain.left);
  EXPECT_EQ(away.hashes, plain.hashes);
  ASSERT_EQ(away.rows.size(), plain.rows.size());
  for (std::size_t f = 0; f < plain.rows.size(); ++f)
    for (const auto& [name, value] : plain.rows[f])
      EXPECT_TRUE(away.rows[f].at(name) == value || std::isnan(value)) << name << " of frame " << f;
  for (std::size_t f = 0; f < plain.frames.size(); ++f) {
    EXPECT_EQ(away.frames[f].position, plain.frames[f].position) << f;
    EXPECT_EQ(away.frames[f].velocity, plain.frames[f].velocity) << f;
    EXPECT_EQ(away.frames[f].id, plain.frames[f].id) << f;
    EXPECT_EQ(away.frames[f].columns, plain.frames[f].columns) << f;
  }
  ASSERT_EQ(plain.probes.size(), 8u);
  for (const auto& [name, text] : plain.probes) {
    EXPECT_GT(std::count(text.begin(), text.end(), '\n'), 3) << name;
    EXPECT_EQ(away.probes.at(name), text) << name;
  }
}

TEST(Away, MatterKeptElsewhereGivesTheSameRun) {
  const auto parsed = scene::parse_scene_text(outflow, "outflow.yaml", {});
  ASSERT_TRUE(parsed.ok()) << parsed.text();
  const fs::path folder = fs::path(DM_BINARY_DIR) / "test-files" / "away";
  const auto seen = [&]<class R>(std::unique_ptr<Backend<R>> backend, const fs::path& probes) {
    Seen all = WatchedRun<R>(parsed.scene, std::move(backend), probes).go(8);
    for (const auto& file : fs::directory_iterator(probes)) all.probes[file.path().stem()] = bytes_of(file.path());
    return all;
  };
  for (const std::string& name : backend_names()) {
    SCOPED_TRACE(name);
    std::visit(
        [&]<class R>(std::unique_ptr<Backend<R>> plain) {
          auto inside = std::get<std::unique_ptr<Backend<R>>>(make_backend(name));
          expect_the_same(seen(std::move(plain), folder / (name + "-plain")),
                          seen(std::unique_ptr<Backend<R>>(std::make_unique<test::Away<R>>(std::move(inside))),
                               folder / (name + "-away")));
        },
        make_backend(name));
  }
}

}  // namespace
}  // namespace dreampm
