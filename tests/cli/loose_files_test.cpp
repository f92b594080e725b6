// dreampm surface and render of files without a run.
#include <gmock/gmock.h>

#include "dreampm/io/ply.h"
#include "dreampm/io/png.h"
#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

/// Two frames of a cube of water that falls, as ASCII PLY with colors.
class LooseFiles : public Typing {
 protected:
  void SetUp() override {
    Typing::SetUp();
    for (int n = 0; n < 2; ++n) {
      std::string text =
          "ply\nformat ascii 1.0\nelement vertex 512\nproperty float x\nproperty float y\nproperty float z\n"
          "property float vx\nproperty float vy\nproperty float vz\nproperty uchar red\nproperty uchar green\n"
          "property uchar blue\nend_header\n";
      for (int i = 0; i < 512; ++i)
        text += fmt::format("{} {} {} 0 -3 0 255 0 0\n", 0.1 * (i % 8), 0.1 * (i / 8 % 8) + 1 - n, 0.1 * (i / 64));
      write(fmt::format("fluid_{}.ply", n), text);
    }
  }
};

TEST_F(LooseFiles, AreWrappedAndDrawn) {
  Typed t = type("surface fluid_0.ply fluid_1.ply --spacing 0.1");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, "surface/fluid_0.ply\nsurface/fluid_1.ply\n");
  const TriMesh mesh = read_mesh(folder / "surface/fluid_1.ply");
  ASSERT_FALSE(mesh.velocities.empty());
  for (const Vec3f& v : mesh.velocities) EXPECT_NEAR(v.y, -3, 1e-4f);

  t = type("render surface/fluid_0.ply surface/fluid_1.ply --samples 2 --scale 0.1 --out pictures");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, "pictures/fluid_0.png\npictures/fluid_1.png\n");
  EXPECT_EQ(read_png(folder / "pictures/fluid_0.png").width, 128);
  EXPECT_NE(read_file(folder / "pictures/fluid_0.png"), read_file(folder / "pictures/fluid_1.png"));
}

TEST_F(LooseFiles, VerticesHoldWhatIsAskedFor) {
  ASSERT_EQ(type("surface fluid_0.ply --spacing 0.1 --attributes color,vorticity").code, 0);
  VertexAttributes got;
  const TriMesh mesh = read_mesh(folder / "surface/fluid_0.ply", &got);
  EXPECT_TRUE(mesh.velocities.empty()) << "not asked for";
  const VertexAttribute* const color = find_attribute(got, "color");
  ASSERT_TRUE(color);
  ASSERT_EQ(color->vertices(), mesh.vertices.size());
  EXPECT_NEAR(color->values[0], 1, 0.01f);
  EXPECT_NEAR(color->values[1], 0, 0.01f);
  const VertexAttribute* const vorticity = find_attribute(got, "vorticity");
  ASSERT_TRUE(vorticity);
  for (const float w : vorticity->values) EXPECT_NEAR(w, 0, 1e-3f) << "it falls without turning";

  Typed t = type("surface fluid_0.ply --spacing 0.1 --attributes age");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("velocity"));
  write("bare.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        "0 0 0\n0.1 0 0\n");
  t = type("surface bare.ply --spacing 0.1 --attributes color --out bare");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("bare.ply: has no colors, of which attribute color is made"));
  EXPECT_FALSE(fs::exists(folder / "bare"));
}

TEST_F(LooseFiles, AreVolumesToo) {
  Typed t = type("surface fluid_0.ply fluid_1.ply --spacing 0.1 --type sdf --out distances");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, "distances/fluid_0.vdb\ndistances/fluid_1.vdb\n");
  t = type("surface fluid_0.ply --spacing 0.1 --type fog --out fog");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(read_file(folder / "fog/fluid_0.vdb"), HasSubstr("fog volume"));
  EXPECT_THAT(read_file(folder / "distances/fluid_0.vdb"), HasSubstr("level set"));
  t = type("surface fluid_0.ply --spacing 0.1 --type sdf --attributes velocity");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("--attributes are of the vertices of meshes; --type sdf has none"));
}

/// Two frames a 24th of a second apart of jets that meet at 6 m/s, as ASCII PLY.
std::string jets(int frame, bool ids) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 2000\nproperty float x\nproperty float y\nproperty float z\n"
      "property float vx\nproperty float vy\nproperty float vz\n";
  text += ids ? "property int id\nend_header\n" : "end_header\n";
  for (int i = 0; i < 2000; ++i) {
    const int side = i < 1000 ? -1 : 1, n = i % 1000;
    const double x = side * (0.01 + 0.02 * (n % 10)) - side * frame * 6.0 / 24 * 0.2;
    text += fmt::format("{} {} {} {} 0 0{}\n", x, 0.02 * (n / 10 % 10), 0.02 * (n / 100), -6 * side,
                        ids ? fmt::format(" {}", i) : "");
  }
  return text;
}

TEST_F(LooseFiles, MakeFoam) {
  for (int n = 0; n < 3; ++n) write(fmt::format("jet_{}.ply", n), jets(n, true));
  Typed t = type("foam jet_0.ply jet_1.ply jet_2.ply --spacing 0.02");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, "foam/jet_0.ply\nfoam/jet_1.ply\nfoam/jet_2.ply\n");
  const ParticleFrame first = read_particles(folder / "foam/jet_0.ply"),
                      last = read_particles(folder / "foam/jet_2.ply");
  EXPECT_EQ(first.size(), 0u) << "nothing has moved yet";
  EXPECT_GT(last.size(), 100u);
  EXPECT_GT(last.columns.at("radius")[0], 0);
  EXPECT_THAT(t.err, HasSubstr("foam: emitted "));
  // It is the same for one thread, and half as much by half the amount, as rounding goes by lot.
  ASSERT_EQ(type("foam jet_0.ply jet_1.ply jet_2.ply --spacing 0.02 --threads 1 --out one").code, 0);
  EXPECT_EQ(read_file(folder / "foam/jet_2.ply"), read_file(folder / "one/jet_2.ply"));
  ASSERT_EQ(type("foam jet_0.ply jet_1.ply jet_2.ply --spacing 0.02 --amount 0.5 --out half").code, 0);
  const double half = static_cast<double>(read_particles(folder / "half/jet_2.ply").size());
  EXPECT_NEAR(half / static_cast<double>(last.size()), 0.5, 0.05);
  // Without ids equally many particles are the same in one order.
  for (int n = 0; n < 3; ++n) write(fmt::format("bare_{}.ply", n), jets(n, false));
  ASSERT_EQ(type("foam bare_0.ply bare_1.ply bare_2.ply --spacing 0.02").code, 0);
  EXPECT_EQ(read_file(folder / "foam/bare_2.ply"), read_file(folder / "foam/jet_2.ply"));
}

TEST_F(LooseFiles, OfWhichNoFoamCanBeMadeSayWhy) {
  const auto refused = [&](const std::string& line) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << line;
    EXPECT_FALSE(fs::exists(folder / "foam")) << line;
    return t.err;
  };
  write("still.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        "0 0 0\n");
  EXPECT_THAT(refused("foam still.ply --spacing 0.1"),
              HasSubstr("still.ply: has no velocities, of which foam is made"));
  EXPECT_THAT(refused("foam fluid_0.ply"), HasSubstr("--spacing"));
  EXPECT_THAT(refused("foam fluid_0.ply --spacing 0.1 --frames 1-2"), HasSubstr("--frames is for a run's folder"));
  write("fewer.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float vx\nproperty float vy\nproperty float vz\nend_header\n0 0 0 0 0 0\n");
  EXPECT_THAT(refused("foam fluid_0.ply fewer.ply --spacing 0.1"),
              HasSubstr("fewer.ply: has no ids, and not as many particles as others"));
}

// Scenes give their voxel in cells, of two spacings: the same number would be another size.
TEST_F(LooseFiles, TheVoxelOfFilesIsInSpacingsAndSaysSo) {
  ASSERT_EQ(type("surface fluid_0.ply --spacing 0.1 --voxel-spacings 1 --out a").code, 0);
  ASSERT_EQ(type("surface fluid_0.ply --spacing 0.1 --voxel 1 --out b").code, 0);
  ASSERT_EQ(type("surface fluid_0.ply --spacing 0.1 --voxel-spacings 0.5 --out c").code, 0);
  EXPECT_EQ(read_file(folder / "a/fluid_0.ply"), read_file(folder / "b/fluid_0.ply"));
  const double ratio = double(read_mesh(folder / "c/fluid_0.ply").triangles.size()) /
                       double(read_mesh(folder / "a/fluid_0.ply").triangles.size());
  EXPECT_GT(ratio, 3);
  EXPECT_LT(ratio, 6);
  const Typed t = type("surface fluid_0.ply --spacing 0.1 --voxel 0.1");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("0.1 is no number from 0.125 to 2 spacings (a scene's surface.voxel is in cells)"));
}

TEST_F(LooseFiles, ParticlesAreBallsInTheirColors) {
  const Typed t = type("render fluid_0.ply --samples 8 --scale 0.2 --elevation 30");
  ASSERT_EQ(t.code, 0) << t.err;
  const RgbImage image = read_png(folder / "render/fluid_0.png");
  std::size_t red = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3)
    red += image.pixels[i] > 2 * image.pixels[i + 1] && image.pixels[i] > 2 * image.pixels[i + 2];
  // The camera is such that the cube fills about half of the picture.
  EXPECT_GT(red, std::size_t(image.width * image.height / 20));
}

TEST_F(LooseFiles, DrawingSaysWhatWasMendedInAFile) {
  // One face of the cube looks inward.
  std::string text = cube;
  const std::string face = "4 0 3 2 1";
  write("cube.off", text.replace(text.find(face), face.size(), "4 0 1 2 3"));
  const Typed t = type("render cube.off --samples 4 --scale 0.05");
  ASSERT_EQ(t.code, 0) << t.err;
  const std::size_t first = t.err.find("cube.off: 2 of 12 faces looked the other way");
  ASSERT_NE(first, std::string::npos) << t.err;
  EXPECT_EQ(t.err.find("looked the other way", first + 50), std::string::npos) << "said once";
}

TEST_F(LooseFiles, IdsAreKeptOrSaidToBeLost) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property double id\nend_header\n";
  write("far.ply", head + "0 0 0 7\n1 0 0 3000000000\n");
  Typed t = type("points far.ply --spacing 1 --out c.ply");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("far.ply: the id of point 1 is 3000000000; a particle file holds -2147483647 to"));
  EXPECT_EQ(read_particles(folder / "c.ply").id, (std::vector<std::int32_t>{0, 1}));
  write("near.ply", head + "0 0 0 7\n1 0 0 3\n");
  t = type("points near.ply --spacing 1 --out c.ply");
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(read_particles(folder / "c.ply").id, (std::vector<std::int32_t>{7, 3}));
  write("half.ply", head + "0 0 0 7\n1 0 0 3.5\n");
  expect_refused("points half.ply --spacing 1 --out d.ply", "half.ply: the id of vertex 1 is 3.5: a whole number");
  EXPECT_FALSE(fs::exists(folder / "d.ply"));
}

/// A PLY file says where its places count from.
TEST_F(LooseFiles, ShiftsAreAdded) {
  const auto shifted = [&](const std::string& name, const std::string& shift) {
    std::string text = read_file(folder / "fluid_0.ply");
    write(name, text.insert(text.find("element"), "comment shift " + shift + "\n"));
  };
  shifted("far.ply", "1000000 0 -2000000.5");
  Typed t = type("surface far.ply --spacing 0.1 --smooth 0");
  ASSERT_EQ(t.code, 0) << t.err;
  const auto bounds = [&](const char* file) {
    const TriMesh mesh = read_mesh(folder / file);
    Box3d box;
    for (const Vec3f& v : mesh.vertices) box.add(static_cast<Vec3d>(v));
    const Vec3d shift = read_ply_shift(folder / file);
    return Box3d{box.min + shift, box.max + shift};
  };
  ASSERT_EQ(type("surface fluid_0.ply --spacing 0.1 --smooth 0").code, 0);
  const Box3d near = bounds("surface/fluid_0.ply"), far = bounds("surface/far.ply");
  EXPECT_NE(read_ply_shift(folder / "surface/far.ply"), (Vec3d{}));
  // In a float, places there are an eighth apart.
  EXPECT_NEAR(length(far.min - near.min - Vec3d{1000000, 0, -2000000.5}), 0, 1e-3);
  EXPECT_NEAR(length(far.size() - near.size()), 0, 1e-3);

  shifted("aside.ply", "2 0 0");
  t = type("render fluid_0.ply aside.ply --samples 2 --scale 0.05");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_NE(read_file(folder / "render/fluid_0.png"), read_file(folder / "render/aside.png"));
  shifted("broken.ply", "1 2");
  for (const char* line : {"surface broken.ply --spacing 0.1 --out s", "render broken.ply --out s"})
    expect_refused(line, "broken.ply: \"comment shift 1 2\" does not read");
  EXPECT_FALSE(fs::exists(folder / "s"));
}

TEST_F(LooseFiles, RefuseWhatCannotBe) {
  write("cube.off", cube);
  write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  fs::copy(folder / "fluid_0.ply", folder / "fluid_0.ply.GZ");
  fs::create_directory(folder / "other");
  fs::copy(folder / "fluid_0.ply", folder / "other/fluid_0.ply");
  const std::pair<const char*, const char*> refused[]{
      {"surface fluid_0.ply",
       "files need --spacing, the distance between particles; those of fluid_0.ply lie about 0.1 "},
      {"surface fluid_0.ply --spacing 0", "--spacing: 0 is no number from 1e-09 to 1"},
      {"surface fluid_0.ply --spacing 1e-8",
       "spacings of 1e-08 from most others, over 500000: leave it out, or use a "},
      {"surface fluid_0.ply --spacing 0.1 --out cube.off", "cube.off: is a file; --out names a folder"},
      {"surface fluid_0.ply --spacing 0.1 --attributes velocity,velocity", "--attributes has velocity twice"},
      {"surface fluid_0.ply none.ply --spacing 0.1", "none.ply: no such file"},
      {"surface fluid_0.ply other/fluid_0.ply --spacing 0.1", "both would become fluid_0.ply"},
      {"surface fluid_0.ply --spacing 0.1 --out .", "fluid_0.ply: would be written over"},
      {"surface cube.off --spacing 0.1", "cube.off: points are read from .ply, .vtk, .vtp, .vtu, .vtkhdf, .bgeo"},
      {"surface fluid_0.ply fluid_0.ply.GZ --spacing 0.1", "both would become fluid_0.ply"},
      {"surface other fluid_0.ply --spacing 0.1", "other: is a folder, of which one is taken"},
      {"surface fluid_0.ply other --spacing 0.1", "other: is a folder among files"},
      {"surface other --spacing 0.1", "--spacing is for files; the run other has its own in its scene"},
      {"surface other", "other: has no scene.yaml: not a run's folder"},
      {"surface none", "none: no such folder"},
      {"render fluid_0.ply --frame 2", "--frame is for a run's folder; of files name those that are to be drawn"},
      {"render open.off --look water", "--look water: clear matter needs a closed mesh"},
      {"render fluid_0.ply --scale 0", "--scale: 0 is no number from 0.01 to 4"},
      {"render fluid_0.ply --samples 1", "--samples: 1 is no whole number from 2 to 65536"},
      {"render cube.off --look gold", "--look: gold not in {"}};
  for (const auto& [line, words] : refused) expect_refused(line, words);
  for (const char* made : {"surface", "render"}) EXPECT_FALSE(fs::exists(folder / made)) << made;
}

}  // namespace
}  // namespace dreampm::test
