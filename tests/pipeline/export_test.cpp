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
    folder_ = fs::path(DM_BINARY_DIR) / "test-files" / "export";
    fs::remove_all(folder_);
    auto parsed = scene::parse_scene_text(R"(dreampm: 1
name: drop
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.04}
time: {fps: 50, frames: 3}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {drop: {material: water, shape: {sphere: {radius: 0.12}, center: [0.2, 0.2, 0.2]}}}
)",
                                          "scene.yaml", {});
    ASSERT_TRUE(parsed.ok()) << parsed.text();
    SilentHost silent;
    const HostScope scope(&silent);
    SimulateOptions options;
    options.folder = folder_ / "run";
    simulate(parsed.scene, {"scene.yaml", std::nullopt}, options);
    RunFolder run = open_run(folder_ / "run", Access::write);
    surface_stage(run);
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

}  // namespace
}  // namespace dreampm
