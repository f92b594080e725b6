// Scenes that start from a moment of another simulation.
#include "dreampm/setup/start.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/io/png.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pipeline/inspect.h"
#include "dreampm/pipeline/make.h"
#include "dreampm/pipeline/preflight.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/render.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::AllOf;
using testing::HasSubstr;

class Start : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("start-{}", ::getpid());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    first.emplace(dam_and_jelly(), quiet());
    first->advance_steps(45);
    first->save_moment(folder / "moment.h5");
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// The scene of dam_and_jelly from that moment on, with values laid over it.
  Scene scene(const std::vector<std::string>& set = {}) {
    model::Scene description = dam_and_jelly().model();
    description.bodies.clear();
    description.start = "moment.h5";
    const std::filesystem::path file = folder / "scene.yaml";
    replace_file_text(file, Scene(std::move(description), file.string()).yaml());
    return load_scene(file, {{}, set});
  }
  std::string refusal(const std::vector<std::string>& set) {
    try {
      Simulation(scene(set), quiet());
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }

  std::filesystem::path folder;
  std::optional<Simulation> first;
};

TEST_F(Start, GoesOnToTheBit) {
  Simulation second(scene(), quiet());
  EXPECT_EQ(second.steps(), 45U);
  EXPECT_EQ(second.hash(), first->hash());
  EXPECT_EQ(second.totals().elastic, first->totals().elastic);
  first->advance_steps(70), second.advance_steps(70);
  EXPECT_EQ(second.hash(), first->hash());
}

TEST_F(Start, OfAnEditedSceneGoesOnFromTheSameParticles) {
  Simulation second(scene({"gravity=[0, 0, 0]"}), quiet());
  EXPECT_EQ(second.totals().mass, first->totals().mass);
  EXPECT_EQ(second.totals().elastic, first->totals().elastic) << "their deformation is kept";
  second.advance_steps(10), first->advance_steps(10);
  EXPECT_GT(second.totals().momentum.y, first->totals().momentum.y);
}

TEST_F(Start, TakesEditsAsOtherSimulationsDo) {
  Simulation second(scene(), quiet());
  const std::size_t before = second.particle_count();
  second.add({"more", "water", Shape::box({0.02, 0.14, 0.04}, {0.08, 0.18, 0.08})});
  EXPECT_GT(second.particle_count(), before);
  second.advance_steps(5);
  const Snapshot now = second.snapshot();
  second.advance_steps(5), second.restore(now);
}

TEST_F(Start, ARunBeginsWithThatFrameAndGoesOnFromItsCheckpoints) {
  const Scene from = scene({"time.frames=12", "output.checkpoint={every: 2}"});
  const int begin = first->frame();
  EXPECT_EQ(first_frame(from.model()), begin);
  ASSERT_GT(begin, 1);
  ASSERT_LT(begin, 10);
  std::vector<std::string> hashes;
  first->on_frame([&](const FrameEvent&) {
    Hash64 h;
    h.add(first->hash());
    hashes.push_back(h.hex());
  });
  first->advance_frames(12 - begin);
  SimulateOptions options;
  options.folder = folder / "run";
  options.frames = 10;
  simulate(from.model(), {from.file(), {}}, options);
  options.frames.reset(), options.resume = true;
  simulate(from.model(), {from.file(), {}}, options);
  const RunRecord record = RunRecord::load(folder / "run" / "run.json");
  ASSERT_EQ(record.frames.size(), static_cast<std::size_t>(12 - begin + 1));
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    EXPECT_EQ(record.frames[i + 1].frame, begin + static_cast<int>(i) + 1);
    EXPECT_EQ(record.frames[i + 1].state_hash, hashes[i]);
  }
}

TEST_F(Start, AFilmIsOfItsFramesAndIsUpToDateAfterwards) {
  const Scene from =
      scene({fmt::format("time.frames={}", first->frame() + 1), "render.size=[64, 48]", "render.samples=4"});
  const MakeOptions options{.folder = folder / "film"};
  EXPECT_TRUE(make(from.model(), {from.file(), {}}, options));
  EXPECT_TRUE(std::filesystem::exists(folder / "film" / (from.name() + ".mp4")));
  EXPECT_FALSE(make(from.model(), {from.file(), {}}, options));
  const Preflight needs = preflight(from.model(), from.file());
  EXPECT_EQ(needs.particles, first->particle_count());
}

// A collider that was dragged, as a hand drags a wall, stands in a film where it was dragged to.
TEST_F(Start, AFilmDrawsWhatWasDraggedWhereItStands) {
  const Scene text = parse_scene(
      "dreampm: 1\nname: slab\nspace: {max: [0.4, 0.2, 0.2], spacing: 0.02}\ntime: {fps: 50, frames: 60}\n"
      "materials: {water: {type: newtonian, preset: water}}\n"
      "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.1, 0.06, 0.2]}}}}\n"
      "colliders: {slab: {shape: {box: {min: [0.36, 0, 0], max: [0.4, 0.16, 0.2]}}, type: slip}}\n"
      "render: {size: [96, 64], samples: 4, looks: {slab: {type: opaque, color: [0.9, 0.1, 0.05]}}}\n",
      "slab.yaml");
  Simulation dragged(text, quiet());
  dragged.set_motion("slab", {{-1, 0, 0}, {}, {}});
  dragged.advance_to(0.14);
  dragged.set_motion("slab", {});
  dragged.advance_frames(1);
  dragged.dt();
  const double moved = dragged.collider("slab").pose.position.x;
  ASSERT_LT(moved, -0.1);
  dragged.save_moment(folder / "slab.h5");
  model::Scene next = text.model();
  next.bodies.clear();
  next.start = "slab.h5", next.time.frames = dragged.frame();
  replace_file_text(folder / "slab.yaml", Scene(std::move(next), (folder / "slab.yaml").string()).yaml());
  const Scene from = load_scene(folder / "slab.yaml");
  const MakeOptions options{.folder = folder / "slab"};
  ASSERT_TRUE(make(from.model(), {from.file(), {}}, options));
  const RunRecord record = RunRecord::load(folder / "slab" / "run.json");
  ASSERT_EQ(record.frames.size(), 1U);
  ASSERT_EQ(record.frames[0].poses.count("slab"), 1U);
  EXPECT_EQ(record.frames[0].poses.at("slab").position.x, moved);
  // The red columns across the picture: as in a picture of the simulation itself.
  const auto red = [](RgbImage picture) {
    double sum = 0, all = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* c = picture.at(x, y);
        const double much = std::max(0, c[0] - c[1] - 60);
        sum += much * x, all += much;
      }
    return all > 0 ? sum / all : -1;
  };
  std::filesystem::path picture;
  for (const auto& file : std::filesystem::directory_iterator(folder / "slab" / "render"))
    if (file.path().extension() == ".png") picture = file.path();
  const double drawn = red(read_png(picture)), seen = red(render(dragged));
  std::printf("red at %.2f in the film, at %.2f in the picture\n", drawn, seen);
  EXPECT_GT(seen, 0);
  EXPECT_NEAR(drawn, seen, 1.5);
}

TEST_F(Start, RefusesWhatDoesNotFit) {
  EXPECT_THAT(refusal({"space.spacing=0.01"}),
              AllOf(HasSubstr("start: "), HasSubstr("moment.h5"), HasSubstr("0.01 m")));
  EXPECT_THAT(refusal({"time.frames=1"}), HasSubstr("frames count from t = 0"));
  EXPECT_THAT(refusal({"materials.more={type: elastic, preset: jelly}"}),
              AllOf(HasSubstr("no material more"), HasSubstr("it has")));
  EXPECT_THAT(refusal({"bodies.dam={material: water, shape: {box: {min: [0, 0, 0], max: [0.1, 0.1, 0.1]}}}"}),
              HasSubstr("bodies together with start"));
  EXPECT_THAT(refusal({"start=gone.h5"}), HasSubstr("gone.h5"));
  SimulationOptions reference = quiet();
  reference.backend = "reference";
  try {
    Simulation(scene(), reference);
    ADD_FAILURE() << "a moment in float is none in double";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("--backend cpu"));
  }
  const Scene there = scene();
  replace_file_text(folder / "moment.h5", "no such thing");
  EXPECT_THROW(Simulation(there, quiet()), InputError);
  std::filesystem::remove(folder / "moment.h5");
  EXPECT_THROW(Simulation(there, quiet()), InputError);
}

// Frames count from t = 0: fewer than the moment's own are refused, before their memory is
// estimated.
TEST_F(Start, TooFewFramesAreRefusedWithTheNumberThatWouldDo) {
  const std::string said = refusal({"time.frames=1"});
  const int frame = start_info(folder / "moment.h5").frame;
  ASSERT_GT(frame, 1);
  EXPECT_THAT(said, AllOf(HasSubstr("time.frames is 1"), HasSubstr(fmt::format("so give {} or more", frame))));
}

TEST_F(Start, InfoSaysWhatAMomentHolds) {
  const Inspection moment = inspect(folder / "moment.h5");
  EXPECT_EQ(moment.kind, "start");
  EXPECT_EQ(moment.count, first->particle_count());
  EXPECT_EQ(moment.by_material.at("water") + moment.by_material.at("jelly"), moment.count);
  EXPECT_EQ(std::get<double>(moment.facts.at("time")), first->time());
}

}  // namespace
}  // namespace dreampm
