// A scene at map coordinates is the scene at the origin: in its files, its meshes, its pictures and
// its probes.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "dreampm/io/ply.h"
#include "dreampm/io/png.h"
#include "dreampm/io/series.h"
#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Places are written as <X Y Z>, counted from the origin of the space. All numbers are sums of few
/// powers of 2.
constexpr const char* scene_text = R"(dreampm: 1
name: NAME
space: {min: <0 0 0>, max: <1 0.5 0.5>, spacing: 0.0625, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 2}
materials: {water: {type: newtonian, preset: water, max_compression: 0.02}, jelly: {type: elastic, preset: jelly}}
bodies:
  column: {material: water, shape: {box: {min: <0 0 0>, max: <0.25 0.375 0.5>}}}
  knot: {material: jelly, shape: {mesh: asset:knot, scale: 0.125, center: <0.625 0.25 0.25>}, color: [1, 0, 0]}
colliders:
  ball: {shape: {sphere: {radius: 0.0625}, center: <0.75 0.0625 0.25>}}
  ramp: {shape: {plane: {point: <0.875 0 0>, normal: [-1, 1, 0]}}}
  notch: {shape: {difference: [{box: {min: <0.3125 0 0>, max: <0.4375 0.125 0.5>}}, {sphere: {radius: 0.0625}, center: <0.375 0.125 0.25>}]}}
probes:
  tank: {type: region, shape: {box: {min: <0 0 0>, max: <0.25 0.5 0.5>}}}
  tip: {type: point, body: column, at: <0.125 0.125 0.25>}
output: {folder: NAME}
surface: {format: obj}
render: {size: [80, 46], samples: 4, noise: 0.1, caustics: false, stage: {floor: none}, camera: {from: <0.5 0.75 2> , to: <0.5 0.125 0.25>}}
)";

constexpr double far_x = 524288, far_z = 16384;

std::string scene_at(double x, double z, const std::string& name) {
  std::string text = std::regex_replace(scene_text, std::regex("NAME"), name), out;
  const std::regex place("<([^ ]+) ([^ ]+) ([^ ]+)>");
  std::smatch m;
  while (std::regex_search(text, m, place)) {
    out += m.prefix().str() + fmt::format("[{}, {}, {}]", x + std::stod(m[1]), m[2].str(), z + std::stod(m[3]));
    text = m.suffix();
  }
  return out + text;
}

class Far : public Typing {};

TEST_F(Far, ASceneAtMapCoordinatesIsTheOneAtTheOrigin) {
  write("near.yaml", scene_at(0, 0, "near"));
  write("far.yaml", scene_at(far_x, far_z, "far"));
  for (const char* name : {"near", "far"}) {
    const Typed t = type(std::string("make ") + name + ".yaml");
    ASSERT_EQ(t.code, 0) << t.err;
  }
  const auto particles = [&](const std::string& name) {
    return read_particles(folder / name / "particles/particles_000002.ply");
  };
  const ParticleFrame near = particles("near"), far = particles("far");
  EXPECT_EQ(near.shift, (Vec3d{}));
  EXPECT_THAT(read_file(folder / "near/particles/particles_000002.ply"), Not(HasSubstr("shift")));
  EXPECT_EQ(far.shift, (Vec3d{far_x, 0, far_z})) << "along y nothing is gained";
  ASSERT_EQ(near.size(), far.size());
  // A double of 5e5 is right to 6e-11, and the run makes little of that: far from what a float
  // loses there, 3 cm.
  for (std::size_t i = 0; i < near.size(); ++i)
    for (int a = 0; a < 3; ++a) ASSERT_NEAR(near.position[i][a], far.position[i][a], 1e-6) << i;
  EXPECT_EQ(record("far").at("shift"), json({far_x, 0.0, far_z}));

  const TriMesh a = read_mesh(folder / "near/surface/water_000002.ply"),
                b = read_mesh(folder / "far/surface/water_000002.ply");
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(a.vertices[i][k], b.vertices[i][k], 1e-5) << i;
  // OBJ has decimal numbers, so that it holds the places themselves.
  double x = 0, y = 0, z = 0;
  const std::string obj = read_file(folder / "far/surface/water_000002.obj");
  ASSERT_EQ(std::sscanf(obj.c_str() + obj.find("\nv "), " v %lf %lf %lf", &x, &y, &z), 3);
  EXPECT_NEAR(x, b.vertices[0].x + far_x, 1e-9);
  EXPECT_NEAR(z, b.vertices[0].z + far_z, 1e-9);

  const RgbImage p = read_png(folder / "near/render/render_000002.png"),
                 q = read_png(folder / "far/render/render_000002.png");
  double difference = 0;
  for (std::size_t i = 0; i < p.pixels.size(); ++i) difference += std::abs(int(p.pixels[i]) - int(q.pixels[i]));
  EXPECT_LT(difference / static_cast<double>(p.pixels.size()), 0.1) << "levels of 255, in the mean";

  const auto last = [&](const std::string& name, const char* probe, const char* column) {
    return read_series(folder / name / "probes" / (std::string(probe) + ".csv")).column(column).back();
  };
  EXPECT_NEAR(last("far", "tip", "x") - far_x, last("near", "tip", "x"), 1e-6);
  EXPECT_NEAR(last("far", "tank", "volume"), last("near", "tank", "volume"), 1e-9);

  for (const char* file : {"particles/particles_000002.ply", "surface/water_000002.ply"}) {
    const json there = json::parse(type(std::string("info far/") + file + " --json").out).at("bounds"),
               here = json::parse(type(std::string("info near/") + file + " --json").out).at("bounds");
    EXPECT_NEAR(there.at("max")[0].get<double>() - far_x, here.at("max")[0].get<double>(), 1e-5) << file;
    EXPECT_NEAR(there.at("min")[2].get<double>() - far_z, here.at("min")[2].get<double>(), 1e-5) << file;
  }
  const Typed info = type("info far/particles/particles_000002.ply");
  EXPECT_THAT(info.out, HasSubstr("bounds           [524288.0")) << "digits where they are needed";
}

TEST_F(Far, BeyondTheDigitsOfADoubleIsRefused) {
  write("far.yaml", scene_at(1e9, 0, "far"));
  const Typed t = type("check far.yaml");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err,
              HasSubstr("far.yaml:3:8: error: space reaches to 1.6e+10 spacings from the origin along x: at most "
                        "1e+09 are possible"));
}

/// Inputs that later stages refuse, refused before anything is simulated.
class Later : public TypingAtADam {
 protected:
  void refused(const std::string& set, const std::string& message) const {
    for (const char* verb : {"check", "make"}) {
      const Typed t = type(std::string(verb) + " dam.yaml " + set);
      EXPECT_EQ(t.code, 2) << verb << " " << set;
      EXPECT_THAT(t.err, HasSubstr(message)) << verb << " " << set;
    }
    EXPECT_FALSE(fs::exists(folder / "out")) << set;
  }
};

TEST_F(Later, WhatRenderAndVideoRefuseIsKnownBefore) {
  refused("--set time.fps=0.0005", "time.fps is 0.0005: must be between 0.001 and 10000");
  refused("--set render.noise=1e-7", "render.noise is 1e-7: must be between 1e-06 and 1");
  refused("--set render.looks.water.absorption=[1e7,0,0]", "must be between 0 and 1e+06 1/m");
  refused("--set render.looks.water.type=spheres --set render.looks.water.radius=1e-50",
          "must be between 0.001 and 10 spacings");
  // Two points whose distance underflows.
  refused("--set render.camera.from=[0,0,0] --set render.camera.to=[1e-200,0,0]",
          "dam.yaml: error: render: the camera's `from` and `to` are the same point");
  refused(
      "--set space.max=[3000,0.4,0.3] --set space.walls.x_max.type=open --set space.spacing=0.01 --set "
      "space.particles_per_cell=64",
      "dam.yaml: error: surface: the space is 6e+05 spacings long");
}

TEST_F(Later, WhatIsJustWithinTheBoundsWorks) {
  const Typed t = type(
      "make dam.yaml --set time.frames=1 --set render.noise=1e-6 --set render.looks.water.ior=1.01 --set "
      "render.camera.fill=0.05 --set render.size=[16,16]");
  EXPECT_EQ(t.code, 0) << t.err;
}

TEST_F(Later, ARunAloneOnlyWarnsOfThem) {
  const Typed t = type("run dam.yaml --frames 1 --set render.camera.from=[0,0,0] --set render.camera.to=[1e-200,0,0]");
  EXPECT_EQ(t.code, 0);
  EXPECT_THAT(t.err, HasSubstr("warning: a later stage will refuse this scene: render: the camera's"));
}

TEST_F(Later, ADiskThatIsTooSmallIsWarnedOf) {
  // 10^6 pictures of 1.6 bytes a pixel: 4e14 bytes.
  const std::string huge = " dam.yaml --set time.frames=1000000 --set render.size=[16384,16384]";
  Typed t = type("check" + huge);
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("warning: the run will take about 429"));
  t = type("run --frames 1" + huge);
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("warning: the run will take about 429"));
}

TEST_F(Later, TheDiskThatParticlesTakeIsKnown) {
  const auto asked = [&](const std::string& attributes) {
    const std::string set = " dam.yaml --set output.particles.attributes=" + attributes;
    return json::parse(type("check --json" + set).out).at("disk_bytes").get<double>();
  };
  ASSERT_EQ(type("run dam.yaml --frames 1 --set output.particles.attributes=[velocity,f,j,color]").code, 0);
  const double plain = asked("[velocity]"), more = asked("[velocity,f,j,color]");
  const double file = static_cast<double>(fs::file_size(folder / "out/dam/particles/particles_000001.ply"));
  EXPECT_NEAR((more - plain) / 3 + 29 * 800, file, 1000) << "a frame, but for its header";
}

}  // namespace
}  // namespace dreampm::test
