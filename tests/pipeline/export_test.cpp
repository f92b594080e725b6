// An export that is broken off, and one that is repeated.
#include "dreampm/pipeline/export_stage.h"

#include <gtest/gtest.h>

#include "dreampm/base/file.h"
#include "dreampm/base/host.h"
#include "dreampm/error.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

/// Asks to stop when it was asked that many times.
class StopsAt final : public Host {
 public:
  explicit StopsAt(int call) : call_(call) {}
  void info(const std::string&) override {}
  void warning(const std::string&) override {}
  bool stop_requested() override { return --call_ < 0; }

 private:
  int call_;
};

class ExportStage : public testing::Test {
 protected:
  void SetUp() override {
    // Tests run beside one another.
    folder_ = fs::path(DM_BINARY_DIR) / "test-files" / "export" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    simulate_scene(R"(dreampm: 1
name: drop
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.04}
time: {fps: 50, frames: 3}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {drop: {material: water, shape: {sphere: {radius: 0.12}, center: [0.2, 0.2, 0.2]}}}
)",
                   "run");
    SilentHost silent;
    const HostScope scope(&silent);
    RunFolder run = open_run(folder_ / "run", Access::write);
    surface_stage(run);
  }
  /// Into a folder of that name.
  void simulate_scene(const std::string& text, const char* name) const {
    const auto parsed = scene::parse_scene_text(text, "scene.yaml", {});
    ASSERT_TRUE(parsed.ok()) << parsed.text();
    SilentHost silent;
    const HostScope scope(&silent);
    SimulateOptions options;
    options.folder = folder_ / name;
    simulate(parsed.scene, {"scene.yaml", std::nullopt}, options);
  }
  std::size_t files() const {
    std::size_t n = 0;
    if (fs::exists(folder_ / "out"))
      for (const auto& e : fs::directory_iterator(folder_ / "out")) n += e.is_regular_file();
    return n;
  }
  ExportOptions to(const exchange::Format& format) const {
    ExportOptions options;
    options.format = format.name;
    options.out = folder_ / "out";
    if (format.one_file()) options.out /= std::string("drop") + format.extension;
    make_folder(folder_ / "out");
    return options;
  }
  fs::path folder_;
};

TEST_F(ExportStage, BrokenOffLeavesWholeFilesOnly) {
  const RunFolder run = open_run(folder_ / "run");
  for (const exchange::Format& format : exchange::formats()) {
    fs::remove_all(folder_ / "out");
    StopsAt host(2);
    const HostScope scope(&host);
    EXPECT_THROW(export_run(run, to(format)), Interrupted) << format.name;
    // Two frames were written: of PLY and OBJ particles and surface.
    const std::size_t each = std::string(format.name) == "ply" || std::string(format.name) == "obj" ? 2 : 1;
    EXPECT_EQ(files(), format.one_file() ? 0 : 2 * each) << format.name;
    for (const auto& e : fs::directory_iterator(folder_ / "out")) EXPECT_NE(e.path().extension(), ".part");
  }
}

TEST_F(ExportStage, TheSameRunGivesTheSameFiles) {
  const RunFolder run = open_run(folder_ / "run");
  SilentHost host;
  const HostScope scope(&host);
  for (const exchange::Format& format : exchange::formats()) {
    if (std::string(format.name) == "vdb") continue;  // OpenVDB gives each file a number by chance
    std::map<fs::path, std::string> first;
    for (const bool again : {false, true}) {
      fs::remove_all(folder_ / "out");
      export_run(run, to(format));
      for (const auto& e : fs::directory_iterator(folder_ / "out")) {
        if (!again)
          first[e.path()] = read_file(e.path());
        else
          EXPECT_TRUE(first.at(e.path()) == read_file(e.path())) << e.path();
      }
    }
    EXPECT_GE(first.size(), 1u);
  }
}

/// A crate that falls, a paddle that turns and a post: each stands in a frame's file where the run
/// has it, also with Z up and in centimeters.
TEST_F(ExportStage, CollidersAndRigidBodiesStandWhereTheRunHasThem) {
  simulate_scene(R"(dreampm: 1
name: zoo
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.04}
time: {fps: 50, frames: 3}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {drop: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.08, 0.12]}}}}
colliders:
  paddle: {shape: {box: {size: [0.04, 0.1, 0.1]}, center: [0.1, 0.3, 0.3]}, motion: {spin: [0, 0, 30]}}
  post: {shape: {box: {min: [0.3, 0, 0.3], max: [0.36, 0.2, 0.36]}}}
rigid: {crate: {shape: {box: {size: [0.1, 0.1, 0.1]}}, density: 400, position: [0.2, 0.3, 0.25]}}
)",
                 "zoo");
  SilentHost silent;
  const HostScope scope(&silent);
  const RunFolder run = open_run(folder_ / "zoo");
  ExportOptions as;
  as.format = "ply", as.particles = false, as.surface = false, as.out = folder_ / "out";
  as.axes = {exchange::Up::z, 100};
  EXPECT_EQ(export_run(run, as).objects, 3u);
  const auto middle = [&](const char* name, int frame) {
    Vec3d sum;
    const TriMesh mesh = read_mesh(folder_ / "out" / fmt::format("collider-{}_{:06}.ply", name, frame));
    for (const Vec3f& v : mesh.vertices) sum += static_cast<Vec3d>(v);
    return as.axes.turned_back(sum / static_cast<double>(mesh.vertices.size())) / 100.0;
  };
  for (const int frame : {1, 3}) {
    const Pose pose = run.frame_record(frame).poses.at("crate");
    EXPECT_NEAR(length(middle("crate", frame) - pose({0.2, 0.3, 0.25})), 0, 1e-5) << frame;
  }
  EXPECT_LT(middle("crate", 3).y, 0.297) << "it fell";
  EXPECT_NEAR(length(middle("post", 3) - Vec3d{0.33, 0.1, 0.33}), 0, 1e-4);  // drawn a hair off the floor
  EXPECT_NEAR(length(middle("paddle", 3) - Vec3d{0.1, 0.3, 0.3}), 0, 1e-5);
  // 30 rad/s for 0.04 s: a corner of (0.02, 0.05) has turned by 1.2 rad.
  const TriMesh paddle = read_mesh(folder_ / "out" / "collider-paddle_000003.ply");
  double highest = 0;
  for (const Vec3f& v : paddle.vertices)
    highest = std::max(highest, as.axes.turned_back(static_cast<Vec3d>(v)).y / 100 - 0.3);
  EXPECT_NEAR(highest, 0.02 * std::sin(1.2) + 0.05 * std::cos(1.2), 1e-4);
  // Nothing of that kind: said, not an empty folder.
  as.out = folder_ / "none";
  EXPECT_THROW(export_run(open_run(folder_ / "run"), as), InputError);
}

// A wall that a hand dragged is a slab behind it, thicker than the box: what lies in the box is
// written, wherever the wall stands.
TEST_F(ExportStage, AWallThatWasDraggedEndsAtTheBox) {
  simulate_scene(R"(dreampm: 1
name: walled
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.04}
time: {fps: 50, frames: 1}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {drop: {material: water, shape: {box: {min: [0, 0, 0], max: [0.2, 0.08, 0.12]}}}}
colliders: {wall-x_max: {shape: {box: {min: [0.3, -0.4, -0.4], max: [0.8, 0.8, 0.8]}}}}
render: {looks: {wall-x_max: {type: dielectric, ior: 1.5}}}
)",
                 "walled");
  SilentHost silent;
  const HostScope scope(&silent);
  ExportOptions as;
  as.format = "ply", as.particles = false, as.surface = false, as.out = folder_ / "out";
  const RunFolder run = open_run(folder_ / "walled");
  export_run(run, as);
  const auto expect = [](const TriMesh& mesh, const Box3d& box) {
    Box3d own;
    for (const Vec3f& v : mesh.vertices) own.add(static_cast<Vec3d>(v));
    EXPECT_NEAR(length(own.min - box.min), 0, 1e-3);
    EXPECT_NEAR(length(own.max - box.max), 0, 1e-3);
  };
  expect(read_mesh(folder_ / "out" / "collider-wall-x_max_000001.ply"), {{0.3, 0, 0}, {0.4, 0.4, 0.4}});
  // In its own frame, where it stands 0.2 m further in.
  const ColliderModels models(run.scene, {});
  expect(models.mesh_within(0, {{-0.2, 0, 0}, {}}), {{0.3, 0, 0}, {0.6, 0.4, 0.4}});
}

}  // namespace
}  // namespace dreampm
