// A run's folder stands for itself: it may move, its models may go, one process works in it, and it
// says what failed.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>

#include <nlohmann/json.hpp>

#include "dreampm/io/png.h"
#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Its mesh is another one of that name.
constexpr const char* wedge = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

/// A glTF model of a wedge, whose data lie in these buffers: members of a JSON list.
std::string wedge_gltf(const std::string& buffers) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
{"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],)" +
         ("\n\"buffers\": [" + buffers + "]}");
}
/// The data: its corners, one of them at (0, `y`, 0), and its faces.
std::string wedge_data(float y) {
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, y, 0, 0, 0, 1};
  return std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
         std::string("\0\0\2\0\1\0\0\0\1\0\3\0\1\0\2\0\3\0\2\0\0\0\3\0", 24);
}

class RunFolder : public Typing {
 protected:
  void SetUp() override {
    Typing::SetUp();
    fs::create_directory(folder / "models of mine");
    write("models of mine/cube.off", cube);
    // A body and a collider that are meshes, and a probe that is one.
    write("scene.yaml", R"(dreampm: 1
name: cubes
space: {min: [0, 0, 0], max: [0.6, 0.4, 0.3], spacing: 0.03, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 3}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {drop: {material: water, shape: {mesh: models of mine/cube.off, scale: 0.18, center: [0.15, 0.15, 0.15]}}}
colliders: {post: {shape: {mesh: models of mine/cube.off, scale: 0.2, center: [0.45, 0.1, 0.15]}}}
probes: {tank: {type: region, shape: {mesh: models of mine/cube.off, scale: 0.3}}}
output: {folder: out/cubes, checkpoint: {every: 1}}
render: {size: [64, 36], samples: 4, noise: 0.1, caustics: false}
)");
  }
  std::string picture(const std::string& run) const { return read_file(folder / run / "render/render_000003.png"); }
};

TEST_F(RunFolder, WorksFromAnywhereAndWithoutItsModels) {
  ASSERT_EQ(type("make scene.yaml").code, 0);
  const std::string drawn = picture("out/cubes");
  ASSERT_EQ(type("run scene.yaml --out moved").code, 0);
  fs::create_directories(folder / "far/models of mine");
  fs::rename(folder / "moved", folder / "far/moved");
  fs::remove_all(folder / "models of mine");
  // Files of that name where the user stands are not taken.
  write("far/models of mine/cube.off", wedge);
  write("far/cube.off", wedge);
  for (const char* verb : {"surface", "render", "video", "info"}) {
    const Typed t = shell("cd far && '" DM_COMMAND "' " + std::string(verb) + " moved");
    EXPECT_EQ(t.code, 0) << verb << ": " << t.err;
  }
  EXPECT_EQ(picture("far/moved"), drawn);
  const Typed t = type("render far/moved");
  EXPECT_EQ(t.err, "nothing to do: far/moved/render is up to date\n");
}

/// Surfaces meet colliders, and pictures show them.
TEST_F(RunFolder, InfoNeedsNoModelAndSurfaceAndRenderSayWhichOne) {
  ASSERT_EQ(type("run scene.yaml").code, 0);
  fs::remove_all(folder / "models of mine");
  fs::remove_all(folder / "out/cubes/models");
  for (const char* line : {"info out/cubes", "info out/cubes/particles/particles_000001.ply"}) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 0) << line << ": " << t.err;
  }
  for (const char* line : {"surface out/cubes", "render out/cubes"}) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << line;
    EXPECT_THAT(t.err, HasSubstr(line[0] == 's' ? "/cube.off: cannot be read: No such file" : "surface of frame 1"));
  }
}

TEST_F(RunFolder, GoesOnAfterItMovedAndItsModelsWent) {
  ASSERT_EQ(type("run scene.yaml --out whole").code, 0);
  ASSERT_EQ(type("run scene.yaml --out cut --frames 2").code, 0);
  fs::rename(folder / "cut", folder / "moved");
  fs::remove_all(folder / "models of mine");
  const Typed t = type("run moved/scene.yaml --out moved --resume");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("going on from checkpoint_000002.h5"));
  EXPECT_EQ(record("moved").at("frames").at(2).at("state_hash"), record("whole").at("frames").at(2).at("state_hash"));
  EXPECT_EQ(read_file(folder / "moved/probes/tank.csv"), read_file(folder / "whole/probes/tank.csv"));
}

TEST_F(RunFolder, KeepsTheModelsOfItsLastSceneOnly) {
  ASSERT_EQ(type("run scene.yaml --frames 1").code, 0);
  const auto kept = [&] {
    int n = 0;
    for (const auto& e : fs::directory_iterator(folder / "out/cubes/models")) n += e.is_directory();
    return n;
  };
  EXPECT_EQ(kept(), 1) << "three shapes name the same file";
  const std::string before = read_file(folder / "out/cubes/scene.yaml");
  write("models of mine/cube.off", wedge);
  ASSERT_EQ(type("run scene.yaml --frames 1 --overwrite").code, 0);
  EXPECT_EQ(kept(), 1);
  EXPECT_NE(read_file(folder / "out/cubes/scene.yaml"), before);
}

TEST_F(RunFolder, KeepsTheBuffersThatAModelNames) {
  fs::create_directories(folder / "wedge/data");
  write("wedge/data/wedge.bin", wedge_data(1));
  write("wedge/wedge.gltf", wedge_gltf(R"({"uri": "data/wedge.bin", "byteLength": 72})"));
  std::string scene = read_file(folder / "scene.yaml");
  const std::string mesh = "mesh: models of mine/cube.off, scale: 0.2";
  scene.replace(scene.find(mesh), mesh.size(), "mesh: wedge/wedge.gltf, scale: 0.2");
  write("scene.yaml", scene);
  Typed t = type("run scene.yaml --frames 1");
  ASSERT_EQ(t.code, 0) << t.err;
  const json before = record("out/cubes");
  fs::remove_all(folder / "wedge/data");
  ASSERT_EQ(type("surface out/cubes").code, 0);
  t = type("render out/cubes");
  EXPECT_EQ(t.code, 0) << t.err;
  // Another buffer is another model.
  make_folder(folder / "wedge/data");
  write("wedge/data/wedge.bin", wedge_data(0.5f));
  ASSERT_EQ(type("run scene.yaml --frames 1 --overwrite").code, 0);
  EXPECT_NE(record("out/cubes").at("scene_hash"), before.at("scene_hash"));
}

TEST_F(RunFolder, IsHeldByOneProcess) {
  ASSERT_EQ(type("run scene.yaml --frames 1").code, 0);
  const int held = ::open((folder / "out/cubes/lock").c_str(), O_RDWR);
  ASSERT_EQ(::flock(held, LOCK_EX | LOCK_NB), 0) << "no process is left that holds it";
  ASSERT_EQ(::pwrite(held, "4711\n", 5, 0), 5);
  for (const char* line : {"run scene.yaml", "run scene.yaml --resume", "make scene.yaml", "surface out/cubes",
                           "render out/cubes", "video out/cubes"}) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << line;
    EXPECT_THAT(t.err, HasSubstr("error: out/cubes: process 4711 works in this folder")) << line;
  }
  EXPECT_EQ(type("info out/cubes").code, 0) << "looking is free";
  ::close(held);
  EXPECT_EQ(type("run scene.yaml --frames 1 --overwrite").code, 0);
}

TEST_F(RunFolder, SaysWhichStageFailedAndThatItNoLongerDoes) {
  ASSERT_EQ(type("run scene.yaml").code, 0);
  const fs::path particles = folder / "out/cubes/particles/particles_000002.ply";
  const std::string whole = read_file(particles);
  replace_file_text(particles, whole.substr(0, whole.size() / 2));
  EXPECT_EQ(type("surface out/cubes").code, 2);
  json run = record("out/cubes");
  EXPECT_EQ(run.at("status"), "failed");
  EXPECT_EQ(run.at("stage"), "surface");
  EXPECT_THAT(run.at("cause").get<std::string>(), HasSubstr("particles_000002.ply"));
  EXPECT_EQ(run.at("stages").at("surface").at("status"), "failed");
  EXPECT_EQ(run.at("stages").at("simulate").at("status"), "complete");
  EXPECT_THAT(type("info out/cubes").out, HasSubstr("failed_stage     surface"));

  replace_file_text(particles, whole);
  ASSERT_EQ(type("surface out/cubes").code, 0);
  run = record("out/cubes");
  EXPECT_EQ(run.at("status"), "complete");
  EXPECT_TRUE(run.at("cause").is_null());
  EXPECT_FALSE(run.contains("stage"));

  ASSERT_EQ(type("render out/cubes").code, 0);
  EXPECT_EQ(type("video out/cubes", "ulimit -f 1").code, 1) << "the film is larger than 512 bytes";
  fs::create_directory(folder / "out/cubes/cubes.mp4");
  EXPECT_EQ(type("video out/cubes").code, 1);
  run = record("out/cubes");
  EXPECT_EQ(run.at("status"), "failed");
  EXPECT_EQ(run.at("stage"), "video");
  fs::remove(folder / "out/cubes/cubes.mp4");
  EXPECT_EQ(type("video out/cubes").code, 0);
  EXPECT_EQ(record("out/cubes").at("status"), "complete");
}

TEST_F(RunFolder, AStageWithAllItsFramesIsComplete) {
  ASSERT_EQ(type("run scene.yaml --frames 1").code, 0);
  ASSERT_EQ(type("surface out/cubes").code, 0);
  json run = record("out/cubes");
  run["status"] = "failed", run["cause"] = "out of memory", run["stage"] = "surface";
  run["stages"]["surface"]["status"] = "failed", run["stages"]["surface"]["cause"] = "out of memory";
  write("out/cubes/run.json", run.dump());
  const Typed t = type("surface out/cubes");
  EXPECT_EQ(t.code, 0);
  EXPECT_THAT(t.err, HasSubstr("nothing to do"));
  run = record("out/cubes");
  EXPECT_EQ(run.at("status"), "complete");
  EXPECT_EQ(run.at("stages").at("surface").at("status"), "complete");
}

TEST_F(RunFolder, DoesNotGoOnWithoutTheRowsOfItsLedger) {
  ASSERT_EQ(type("run scene.yaml --frames 2").code, 0);
  const std::string ledger = read_file(folder / "out/cubes/ledger.csv");
  write("out/cubes/ledger.csv", ledger.substr(0, ledger.find('\n') + 1));
  const Typed t = type("run scene.yaml --resume");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("ledger.csv: has no row of frame 2"));
}

TEST_F(RunFolder, ABufferThatIsNotThereLeavesTheEarlierRun) {
  ASSERT_EQ(type("run scene.yaml --frames 1").code, 0);
  // No face lies in its second buffer, so that the mesh can be read.
  write("wedge.bin", wedge_data(1));
  write("wedge.gltf", wedge_gltf(R"({"uri": "wedge.bin", "byteLength": 72}, {"uri": "", "byteLength": 4})"));
  std::string scene = read_file(folder / "scene.yaml");
  const std::string mesh = "mesh: models of mine/cube.off, scale: 0.2";
  scene.replace(scene.find(mesh), mesh.size(), "mesh: wedge.gltf, scale: 0.2");
  write("scene.yaml", scene);
  const Typed t = type("run scene.yaml --frames 1 --overwrite");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("error: wedge.gltf: its buffer \"\" is not there"));
  EXPECT_TRUE(fs::exists(folder / "out/cubes/particles/particles_000001.ply"));
}

TEST_F(RunFolder, ARefusedSceneLeavesNoFolder) {
  write("bad.yaml",
        std::string(tiny_dam).replace(std::string(tiny_dam).find("min: [0, 0, 0], max: [0.24"), 14, "min: [-1, 0, 0]"));
  for (const char* verb : {"check", "run", "make"}) {
    const Typed t = type(std::string(verb) + " bad.yaml");
    EXPECT_EQ(t.code, 2) << verb;
    EXPECT_THAT(t.err, HasSubstr("outside the wall x_min")) << verb;
    EXPECT_FALSE(fs::exists(folder / "out")) << verb;
  }
  // All files stay as they are, but for the log.
  ASSERT_EQ(type("run scene.yaml --frames 1").code, 0);
  const std::string before = read_file(folder / "out/cubes/run.json");
  EXPECT_EQ(type("run bad.yaml --out out/cubes --overwrite").code, 2);
  EXPECT_EQ(read_file(folder / "out/cubes/run.json"), before);
  EXPECT_EQ(type("run bad.yaml --out out/dam").code, 2);
  EXPECT_FALSE(fs::exists(folder / "out/dam"));
}

TEST_F(RunFolder, CheckKnowsWhatAVideoTakes) {
  for (const char* line : {"check scene.yaml --set time.fps=0.0005", "make scene.yaml --set time.fps=10001"}) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << line;
    EXPECT_THAT(t.err, HasSubstr("must be between 0.001 and 10000")) << line;
  }
  const Typed t = type("make scene.yaml --set time.fps=0.001 --set time.frames=1");
  EXPECT_EQ(t.code, 0) << t.err;
}

}  // namespace
}  // namespace dreampm::test
