// A scene's way to a film, and what a second call does.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "dreampm/io/ledger.h"
#include "dreampm/io/ply.h"
#include "dreampm/io/png.h"
#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Make : public TypingAtADam {
 protected:
  int count(const std::string& in, const std::string& extension) const {
    int n = 0;
    for (const auto& e : fs::directory_iterator(folder / "out" / "dam" / in)) n += e.path().extension() == extension;
    return n;
  }
  fs::file_time_type time_of(const std::string& file) const {
    return fs::last_write_time(folder / "out" / "dam" / file);
  }
};

TEST_F(Make, WritesEveryFileThenHasNothingToDo) {
  Typed t = type("make dam.yaml --threads 2");
  ASSERT_EQ(t.code, 0) << t.err;
  const fs::path out = folder / "out" / "dam";
  for (const char* file : {"scene.yaml", "run.json", "ledger.csv", "log.txt", "dam.mp4", "contact-sheet.png",
                           "particles/particles_000001.ply", "surface/surface_000002.ply", "render/render_000003.png"})
    EXPECT_TRUE(fs::exists(out / file)) << file;
  EXPECT_EQ(count("particles", ".ply"), 3);
  EXPECT_EQ(count("surface", ".ply"), 3);
  EXPECT_EQ(count("render", ".png"), 3);
  EXPECT_EQ(count("checkpoint", ".h5"), 1);
  EXPECT_EQ(read_ledger(out / "ledger.csv").rows.size(), 3u);
  EXPECT_EQ(read_png(out / "render" / "render_000002.png").width, 64);
  const json run = record("out/dam");
  EXPECT_EQ(run.at("status"), "complete");
  EXPECT_EQ(run.at("frames").size(), 3u);
  for (const char* stage : {"simulate", "surface", "render", "video"})
    EXPECT_EQ(run.at("stages").at(stage).at("frames"), 3) << stage;

  const auto particles = time_of("particles/particles_000003.ply"), film = time_of("dam.mp4");
  t = type("make dam.yaml");
  EXPECT_EQ(t.code, 0);
  EXPECT_EQ(t.err, "nothing to do: out/dam is up to date\n");
  EXPECT_EQ(time_of("particles/particles_000003.ply"), particles);
  EXPECT_EQ(time_of("dam.mp4"), film);
  EXPECT_THAT(type("surface out/dam").err, HasSubstr("nothing to do"));
  EXPECT_THAT(type("render out/dam").err, HasSubstr("nothing to do"));
  EXPECT_THAT(type("video out/dam").err, HasSubstr("nothing to do"));

  t = type("info out/dam/particles/particles_000001.ply --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json info = json::parse(t.out);
  EXPECT_EQ(info.at("kind"), "particles");
  EXPECT_EQ(info.at("count"), 800);
  EXPECT_NEAR(info.at("mass").get<double>(), 1000 * 0.24 * 0.3 * 0.3, 1e-6);
  EXPECT_EQ(info.at("state_hash"), run.at("frames")[0].at("state_hash"));
}

TEST_F(Make, AChangedKeyRedoesOnlyWhatItMust) {
  ASSERT_EQ(type("make dam.yaml").code, 0);
  const auto particles = time_of("particles/particles_000003.ply"), surface = time_of("surface/surface_000001.ply"),
             picture = time_of("render/render_000001.png"), film = time_of("dam.mp4");
  Typed t = type("make dam.yaml --set render.camera.azimuth=20");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("changed: render.camera.azimuth: 60 -> 20\n"));
  EXPECT_THAT(t.err, HasSubstr("render: the render settings changed: 3 of 3 frames again\n"));
  EXPECT_THAT(t.err, HasSubstr("video: the pictures changed"));
  EXPECT_THAT(t.err, Not(HasSubstr("simulate")));
  EXPECT_THAT(t.err, Not(HasSubstr("surface:")));
  EXPECT_EQ(time_of("particles/particles_000003.ply"), particles);
  EXPECT_EQ(time_of("surface/surface_000001.ply"), surface);
  EXPECT_GT(time_of("render/render_000001.png"), picture);
  EXPECT_GT(time_of("dam.mp4"), film);

  // A picture of another size counts as another one; make brings the scene's back.
  ASSERT_EQ(type("render out/dam --frame 2 --scale 2 --samples 2").code, 0);
  EXPECT_EQ(read_png(folder / "out/dam/render/render_000002.png").width, 128);
  t = type("make dam.yaml --set render.camera.azimuth=20");
  EXPECT_THAT(t.err, HasSubstr("1 of 3 frames again"));
  EXPECT_EQ(read_png(folder / "out/dam/render/render_000002.png").width, 64);

  fs::remove(folder / "out/dam/surface/surface_000002.ply");
  t = type("make dam.yaml --set surface.smooth=1 --set render.camera.azimuth=20");
  EXPECT_THAT(t.err, HasSubstr("surface: the surface settings changed: 3 of 3 frames again\n"));
  EXPECT_EQ(time_of("particles/particles_000003.ply"), particles);

  t = type("make dam.yaml --set gravity=[0,-5,0]");
  EXPECT_THAT(t.err, HasSubstr("simulate: the scene changed: starts again\n"));
  EXPECT_THAT(t.err, HasSubstr("surface: the simulation changed: 3 of 3 frames again\n"));
  EXPECT_GT(time_of("particles/particles_000003.ply"), particles);
}

TEST_F(Make, AnotherFormatOfTheSurfaceDrawsNothingAgainAndLeavesNothingOld) {
  ASSERT_EQ(type("make dam.yaml").code, 0);
  const auto picture = time_of("render/render_000001.png");
  Typed t = type("make dam.yaml --set surface.format=obj");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("surface: surface_000001.obj is not there: 3 of 3 frames again\n"));
  EXPECT_THAT(t.err, Not(HasSubstr("render:")));
  EXPECT_EQ(time_of("render/render_000001.png"), picture);
  EXPECT_EQ(count("surface", ".obj"), 3);
  // Meshes of another run must not stay behind, nor its frames.
  t = type("make dam.yaml --set gravity=[0,-5,0] --set time.frames=2");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(count("surface", ".obj"), 0);  // of the third frame neither
  EXPECT_EQ(count("particles", ".ply"), 2);
  EXPECT_EQ(count("surface", ".ply"), 2);
}

TEST_F(Make, TheVolumeOfAMeshStandsBesideThatOfItsParticles) {
  ASSERT_EQ(type("run dam.yaml").code, 0);
  Typed t = type("surface out/dam");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("surface: water: at frame 1 the particles take "));
  EXPECT_THAT(read_file(folder / "out/dam/log.txt"), HasSubstr("surface: water: at frame 1 the particles take "));
  const json volumes = record("out/dam").at("stages").at("surface").at("volumes");
  ASSERT_EQ(volumes.size(), 3u);
  EXPECT_EQ(volumes[0].at("material"), "water");
  EXPECT_NEAR(volumes[0].at("particles").get<double>(), 0.24 * 0.3 * 0.3, 1e-9);
  EXPECT_NEAR(volumes[0].at("mesh").get<double>() / (0.24 * 0.3 * 0.3), 1, 0.05);
  EXPECT_NEAR(volumes[0].at("taken").get<double>() / (0.24 * 0.3 * 0.3), 1, 0.05);
  t = type("info out/dam/surface/surface_000001.ply --json");
  const json info = json::parse(t.out);
  EXPECT_EQ(info.at("frame"), 1);
  EXPECT_EQ(info.at("open_edges"), 0);
  EXPECT_NEAR(info.at("volume_error").get<double>(),
              volumes[0].at("mesh").get<double>() / volumes[0].at("particles").get<double>() - 1, 1e-5);
  EXPECT_EQ(info.at("taken_volume"), volumes[0].at("taken"));
  EXPECT_THAT(type("info out/dam").out, HasSubstr("water: at frame 1 the particles take "));
}

/// Returns the message of `surface` for frame 1: by how much the particles are off their rest
/// volume, and the mesh off that [%].
std::array<double, 2> culprits(const std::string& text) {
  const std::regex line(
      "at frame 1 the particles take ([-+0-9.]+) % of their rest volume; the mesh ([-+0-9.]+) % of that");
  std::smatch found;
  if (!std::regex_search(text, found, line)) return {NAN, NAN};
  return {std::stod(found[1]), std::stod(found[2])};
}

TEST_F(Make, AMeshIsNotBlamedForWaterThatHasSwollen) {
  ASSERT_EQ(type("run dam.yaml").code, 0);
  const fs::path file = folder / "out/dam/particles/particles_000001.ply";
  ParticleFrame frame = read_particles(file);
  for (Vec3f& p : frame.position) p.y *= 1.5f;
  write_particles(file, frame);
  const Typed t = type("surface out/dam");
  ASSERT_EQ(t.code, 0) << t.err;
  const auto [particles, mesh] = culprits(t.err);
  EXPECT_NEAR(particles, 50, 5) << t.err;
  EXPECT_NEAR(mesh, 0, 8) << t.err;
}

TEST_F(Make, WaterIsNotBlamedForAMeshThatIsOff) {
  // Smoothed for long, a coarse mesh shrinks.
  ASSERT_EQ(type("run dam.yaml --set surface.smooth=10 --set surface.voxel=1").code, 0);
  const Typed t = type("surface out/dam");
  ASSERT_EQ(t.code, 0) << t.err;
  const auto [particles, mesh] = culprits(t.err);
  EXPECT_NEAR(particles, 0, 3) << t.err;
  EXPECT_LT(mesh, -10) << t.err;
}

TEST_F(Make, ObstaclesAndColorsOfBodiesAreSeen) {
  // Two jellies of one material, a red and a blue one, and a post: three pictures that must differ.
  const std::string scene = R"(dreampm: 1
name: dam
space: {min: [0, 0, 0], max: [0.6, 0.4, 0.3], spacing: 0.03}
time: {fps: 24, frames: 1}
materials: {jelly: {type: elastic, preset: jelly}}
bodies:
  one: {material: jelly, shape: {box: {min: [0, 0, 0], max: [0.15, 0.15, 0.3]}}, color: [1, 0, 0]}
  two: {material: jelly, shape: {box: {min: [0.45, 0, 0], max: [0.6, 0.15, 0.3]}}, color: [0, 0, 1]}
output: {folder: out/dam}
render: {size: [64, 36], samples: 4, noise: 0.1, camera: {from: [0.3, 0.6, 1.2], to: [0.3, 0.1, 0.15]}}
)";
  write("dam.yaml", scene);
  ASSERT_EQ(type("make dam.yaml").code, 0);
  const auto sides = [&] {  // red minus blue, summed over the left and the right third
    const RgbImage image = read_png(folder / "out/dam/render/render_000001.png");
    std::array<int, 2> sum{};
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (x < image.width / 3 || x >= image.width * 2 / 3)
          sum[x >= image.width / 2] += image.at(x, y)[0] - image.at(x, y)[2];
    return sum;
  };
  const auto two = sides();
  EXPECT_GT(two[0], two[1] + 3000);
  const std::string without = read_file(folder / "out/dam/render/render_000001.png");
  write("dam.yaml", scene + "colliders: {post: {shape: {box: {size: [0.1, 0.3, 0.1]}, center: [0.3, 0.15, 0.15]}}}\n");
  const Typed t = type("make dam.yaml");
  ASSERT_EQ(t.code, 0) << t.err;
  const RgbImage image = read_png(folder / "out/dam/render/render_000001.png");
  const std::uint8_t* middle = image.at(image.width / 2, image.height / 2);
  EXPECT_LT(std::max({middle[0], middle[1], middle[2]}) - std::min({middle[0], middle[1], middle[2]}), 60) << "gray";
  EXPECT_NE(read_file(folder / "out/dam/render/render_000001.png"), without);
}

TEST_F(Make, MoreFramesContinueTheRun) {
  ASSERT_EQ(type("make dam.yaml").code, 0);
  const auto third = time_of("particles/particles_000003.ply"), picture = time_of("render/render_000003.png");
  const Typed t = type("make dam.yaml --set time.frames=5");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("going on from"));
  EXPECT_EQ(count("render", ".png"), 5);
  EXPECT_EQ(time_of("particles/particles_000003.ply"), third);
  EXPECT_EQ(time_of("render/render_000003.png"), picture);
}

TEST_F(Make, StagesByHandGiveTheSameRun) {
  ASSERT_EQ(type("run dam.yaml").code, 0);
  Typed t = type("render out/dam");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("dreampm surface out/dam makes it"));
  ASSERT_EQ(type("surface out/dam").code, 0);
  t = type("video out/dam");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("render_000001.png: is missing"));
  ASSERT_EQ(type("render out/dam --frames 1-2").code, 0);
  EXPECT_EQ(count("render", ".png"), 2);
  EXPECT_EQ(type("render out/dam --frame 4").code, 2);
  EXPECT_EQ(type("render out/dam --frames 2-x").code, 2);
  ASSERT_EQ(type("render out/dam").code, 0);
  ASSERT_EQ(type("video out/dam").code, 0);
  t = type("make dam.yaml");
  EXPECT_THAT(t.err, HasSubstr("nothing to do"));
}

TEST_F(Make, GrainsAreDrawnAsSpheresWithoutASurface) {
  const Typed t = type("make dam.yaml --set render.looks.water.type=spheres");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_FALSE(fs::exists(folder / "out/dam/surface"));
  EXPECT_EQ(count("render", ".png"), 3);
}

TEST_F(Make, AFolderUnderAFileIsRefused) {
  write("notes", "a file");
  const Typed t = type("make dam.yaml --out notes/here");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("error: notes/here"));
}

TEST_F(Make, AFileThatMayNotGrowIsToldAndGoneOnFrom) {
  // 16 blocks of 512 bytes: less than a frame of 800 particles, and less than any picture's share
  // of a full disk.
  Typed t = type("make dam.yaml", "ulimit -f 16");
  EXPECT_EQ(t.code, 1) << t.err;
  EXPECT_THAT(t.err, HasSubstr("particles_000001.ply"));
  EXPECT_THAT(t.err, HasSubstr("File too large"));
  EXPECT_EQ(count("particles", ".ply"), 0);
  const json run = record("out/dam");
  EXPECT_EQ(run.at("status"), "failed");
  EXPECT_THAT(run.at("cause"), HasSubstr("particles_000001.ply"));
  t = type("make dam.yaml");
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("no checkpoint to go on from: starts at frame 1\n"));
}

TEST_F(Make, ARunSaysWhetherItGoesOnOrStartsAgain) {
  Typed t = type("run dam.yaml --backend reference --resume");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("no checkpoint to go on from: starts at frame 1\n"));
  t = type("run dam.yaml --resume");  // by the backend of the run
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(record("out/dam").at("backend"), "reference");
  t = type("run dam.yaml --resume --backend cpu");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err,
              HasSubstr("checkpoint_000003.h5: is in double, as the backend reference computes, and not in float"));
  EXPECT_EQ(count("particles", ".ply"), 3);
  t = type("run dam.yaml --overwrite");
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("simulate: starts again: replaces 3 frames of an earlier run\n"));
}

// Hours may be in it: one arrow up must not take them away.
TEST_F(Make, ARunIsNotReplacedUnlessItIsSaid) {
  ASSERT_EQ(type("run dam.yaml").code, 0);
  const auto before = time_of("particles/particles_000003.ply");
  Typed t = type("run dam.yaml");
  EXPECT_EQ(t.code, 2);
  EXPECT_EQ(t.err,
            "error: out/dam: has 3 frames of an earlier run, which is whole: go on with it by --resume, replace it by "
            "--overwrite, or name another folder by --out\n");
  EXPECT_EQ(time_of("particles/particles_000003.ply"), before);
  EXPECT_EQ(type("run dam.yaml --out out/other").code, 0);
  EXPECT_EQ(type("run dam.yaml --resume").code, 0);
  EXPECT_EQ(time_of("particles/particles_000003.ply"), before);
  EXPECT_EQ(type("run dam.yaml --resume --overwrite").code, 2) << "one of them";
  // One that was interrupted can go on from its checkpoint; without one nothing could.
  json run = record("out/dam");
  run["stages"]["simulate"]["status"] = run["status"] = "interrupted";
  replace_file_text(folder / "out/dam/run.json", run.dump());
  t = type("run dam.yaml");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("has 3 frames of an earlier run, which can go on: "));
  fs::remove_all(folder / "out/dam/checkpoint");
  EXPECT_EQ(type("run dam.yaml").code, 0);
  EXPECT_EQ(type("run dam.yaml --overwrite --frames 2").code, 0);
  EXPECT_EQ(count("particles", ".ply"), 2);
  EXPECT_EQ(type("make dam.yaml --set gravity=[0,-5,0]").code, 0) << "make knows what is whole";
}

TEST_F(Make, AModelReplacesTheOnlyMesh) {
  Typed t = type("make dam.yaml --model asset:knot");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("0 bodies with a mesh"));
  std::string scene = tiny_dam;
  const std::string box = "box: {min: [0, 0, 0], max: [0.24, 0.3, 0.3]}";
  scene.replace(scene.find(box), box.size(),
                "mesh: asset:stanford-dragon, fit: {longest: 0.25}, center: [0.3, 0.15, 0.15]");
  write("dam.yaml", scene);
  t = type("make dam.yaml --model asset:knot");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(read_file(folder / "out/dam/scene.yaml"), HasSubstr("asset:knot"));
  EXPECT_THAT(t.err, Not(HasSubstr("outside the walls")));
}

TEST_F(Make, AModelThatIsTooLargeForTheWallsIsMadeSmaller) {
  // A cube of 1 m whose longest side shall be 0.5 m, in a basin 0.3 m wide.
  write("cube.off", cube);
  std::string scene = tiny_dam;
  const std::string box = "box: {min: [0, 0, 0], max: [0.24, 0.3, 0.3]}";
  scene.replace(scene.find(box), box.size(),
                "mesh: cube.off, fit: {longest: 0.5}, rotate: {axis: y, angle: 45}, center: [0.3, 0.2, 0.15]");
  write("dam.yaml", scene);
  EXPECT_EQ(type("check dam.yaml").code, 2);
  const Typed t = type("make dam.yaml --model cube.off --set time.frames=1");
  ASSERT_EQ(t.code, 0) << t.err;
  // Its half diagonal is 0.15 m - a spacing: 0.12 sqrt(2) m a side.
  EXPECT_THAT(t.err, HasSubstr("cube.off: 0.5 m long as the scene asks reaches outside the walls; made 0.1697 m long"));
}

TEST_F(Make, CheckSaysHowMuchFoamThereIsAtMost) {
  EXPECT_THAT(type("check dam.yaml").out, Not(HasSubstr("foam")));
  const Typed t = type("check dam.yaml --set foam.most=500000");
  EXPECT_THAT(t.out, HasSubstr("foam      at most 500,000 grains at once: "));
  const auto foam = nlohmann::json::parse(type("check --json dam.yaml --set foam.most=500000").out).at("foam");
  EXPECT_EQ(foam.at("most"), 500000);
  EXPECT_GT(foam.at("memory_bytes"), 140 * 500000);
  EXPECT_EQ(foam.at("frame_bytes"), 41 * 500000) << "a row of foam/foam_NNNNNN.ply";
}

TEST_F(Make, TheDemoRunsWithTheShapeThatNeedsNoFile) {
  const std::string scene = DM_SOURCE_DIR "/scenes/dragon-splatting.yaml";
  const Typed t = type("make " + scene +
                       " --variant preview --model asset:knot --out knot --set space.spacing=0.04 --set time.frames=1 "
                       "--set render.size=[32,18] --set render.samples=4");
  EXPECT_EQ(t.code, 0) << t.err;
}

/// A scene alone cannot open the ledger, but a ledger that is not of the checkpoint beside it can:
/// a strict run that goes on from there finds that momentum jumped between the last row kept and
/// its first own.
TEST_F(Make, AStrictRunWhoseLedgerDoesNotCloseFailsAndNamesTheGap) {
  const fs::path out = folder / "out" / "dam";
  ASSERT_EQ(type("run dam.yaml --frames 2 --strict").code, 0);
  const std::string text = read_file(out / "ledger.csv");
  const auto resumed = [&](double more, const std::string& strict) {
    EXPECT_EQ(type("run dam.yaml --frames 2 --overwrite").code, 0);
    // The last row's momentum along y, in its column.
    std::size_t at = text.rfind('\n', text.size() - 2) + 1;
    const std::string head = text.substr(0, text.find("momentum_y"));
    for (auto commas = std::count(head.begin(), head.end(), ','); commas > 0; --commas) at = text.find(',', at) + 1;
    const std::size_t length = text.find(',', at) - at;
    std::string changed = text;
    changed.replace(at, length, exact_text(std::stod(text.substr(at, length)) + more));
    replace_file_text(out / "ledger.csv", changed);
    return type("run dam.yaml --resume" + strict);
  };
  const Typed t = resumed(0.1, " --strict");  // N s, of 27 kg that fall
  EXPECT_EQ(t.code, 1);
  EXPECT_THAT(t.err, HasSubstr("error: the ledger does not close at frame 3: momentum_y changed by "));
  EXPECT_THAT(t.err, HasSubstr("a gap of -0.1, while rounding explains "));
  const json run = record("out/dam");
  EXPECT_EQ(run.at("status"), "failed");
  EXPECT_THAT(run.at("cause").get<std::string>(), HasSubstr("momentum_y"));
  EXPECT_EQ(resumed(0, " --strict").code, 0);
  EXPECT_EQ(resumed(0.1, "").code, 0) << "only a strict run is held to it";
}

}  // namespace
}  // namespace dreampm::test
