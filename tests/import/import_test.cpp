#include "dreampm/import/import.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "dreampm/base/file.h"
#include "geometry/meshes.h"

using namespace dreampm;
using ::testing::Test;

namespace {

class Import : public InFolder {
 protected:
  void expect_refused(const std::string& name, const std::string& content, const std::string& reason) const {
    const auto path = file(name, content);
    const std::string text = refusal([&] { import_mesh(path); });
    EXPECT_NE(text.find(reason), std::string::npos) << text;
    EXPECT_NE(text.find(name), std::string::npos) << text;
  }
};

const std::string tetra_head =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
const std::string tetra_vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string tetra_faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// The tetrahedron's 48 bytes of positions, then its indices.
std::string gltf_bytes(const std::vector<std::uint16_t>& indices) {
  std::string bin;
  for (const float v : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) bin.append(reinterpret_cast<const char*>(&v), 4);
  for (const std::uint16_t i : indices) bin.append(reinterpret_cast<const char*>(&i), 2);
  return bin;
}
std::string gltf_of(const std::string& bin) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"translation":[5,0,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "buffers":[{"uri":")" +
         bin + R"(","byteLength":72}],"bufferViews":[{"buffer":0,"byteLength":48},
    {"buffer":0,"byteOffset":48,"byteLength":24}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,
    "type":"VEC3","min":[0,0,0],"max":[1,1,1]},{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

TEST_F(Import, ReadsEveryKind) {
  const auto same = [&](const std::filesystem::path& path) {
    const Model mesh = import_mesh(path);
    EXPECT_EQ(mesh.vertices.size(), 4u) << path;
    EXPECT_EQ(mesh.triangles.size(), 4u) << path;
    EXPECT_NEAR(enclosed_volume(mesh), 1.0 / 6, 1e-6) << path;
  };
  same(file("t.ply", tetra_head + tetra_vertices + tetra_faces));
  same(file("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
  same(file("t.off", "OFF\n4 4 6\n" + tetra_vertices + tetra_faces));
  std::string stl = "solid t\n";
  const char* corners[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  for (const auto& f : {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int v : f) stl += std::string("vertex ") + corners[v] + "\n";
    stl += "endloop\nendfacet\n";
  }
  same(file("t.stl", stl + "endsolid t\n"));

  file("t.bin", gltf_bytes({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  same(file("t.gltf", gltf_of("t.bin")));
}

// A glTF file may name no scene to show, and need not have one.
TEST_F(Import, ReadsGltfWithoutAScene) {
  file("t.bin", gltf_bytes({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  const std::string whole = gltf_of("t.bin"), shown = R"("scene":0,)", scenes = R"("scenes":[{"nodes":[0]}],)",
                    nodes = R"("nodes":[{"mesh":0,"translation":[5,0,0]}],)";
  const auto without = [&](std::initializer_list<std::string> parts) {
    std::string text = whole;
    for (const std::string& part : parts) text.erase(text.find(part), part.size());
    return text;
  };
  const auto bounds = [&](const std::filesystem::path& path) {
    const Model mesh = import_mesh(path);
    EXPECT_EQ(mesh.triangles.size(), 4u) << path;
    Box3d box;
    for (const Vec3d& v : mesh.vertices) box.add(v);
    return box;
  };
  EXPECT_EQ(bounds(file("shown.gltf", without({shown}))).min, (Vec3d{5, 0, 0}));
  EXPECT_EQ(bounds(file("nodes.gltf", without({shown, scenes}))).min, (Vec3d{5, 0, 0}));
  EXPECT_EQ(bounds(file("meshes.gltf", without({shown, scenes, nodes}))).min, (Vec3d{}));
  // The same as one chunk of JSON and one of numbers.
  std::string json = without({shown, scenes});
  const std::string uri = R"("uri":"t.bin",)";
  json.erase(json.find(uri), uri.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string bin = gltf_bytes({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  const auto number = [](std::size_t n) {
    const auto small = static_cast<std::uint32_t>(n);
    return std::string(reinterpret_cast<const char*>(&small), sizeof small);
  };
  const std::string glb = "glTF" + number(2) + number(12 + 8 + json.size() + 8 + bin.size()) + number(json.size()) +
                          "JSON" + json + number(bin.size()) + std::string("BIN\0", 4) + bin;
  EXPECT_EQ(bounds(file("nodes.glb", glb)).min, (Vec3d{5, 0, 0}));
}

TEST_F(Import, ReadsGzipAndSaysWhenItIsCut) {
  const std::string text = tetra_head + tetra_vertices + tetra_faces;
  const auto path = folder / "t.ply.gz";
  gzFile gz = gzopen(path.c_str(), "wb");
  gzwrite(gz, text.data(), unsigned(text.size()));
  gzclose(gz);
  EXPECT_EQ(import_mesh(path).triangles.size(), 4u);
  const std::string packed = read_file(path);
  expect_refused("cut.ply.gz", packed.substr(0, packed.size() / 2), "cut short");
  expect_refused("nocheck.ply.gz", packed.substr(0, packed.size() - 6), "cut short");
  std::string broken = packed;
  broken[packed.size() - 6] ^= 0x55;  // the check sum
  expect_refused("broken.ply.gz", broken, "damaged");
}

TEST_F(Import, CutsPolygonsIntoTriangles) {
  const auto path =
      file("quad.ply",
           "ply\r\nformat ascii 1.0\r\ncomment a quad\r\nelement vertex 4\r\nproperty double x\r\nproperty "
           "double y\r\nproperty double z\r\nelement face 1\r\nproperty list uchar uint vertex_index\r\n"
           "end_header\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3\r\n");
  EXPECT_EQ(import_mesh(path).triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

/// A comb of many teeth: each takes an ear of its own, and a look at all corners for each would
/// take minutes.
TEST_F(Import, CutsAPolygonOfManyCornersQuickly) {
  constexpr int teeth = 10000;
  std::string text = "v 0 -1 0\nv " + std::to_string(teeth) + " -1 0\n", face = "f 1 2";
  for (int i = teeth; i > 0; --i) {
    text += "v " + std::to_string(i) + " 0 0\nv " + std::to_string(i) + ".0 1 0\n";
    text += "v " + std::to_string(i - 1) + ".5 0 0\n";
  }
  for (int n = 3; n < 3 + 3 * teeth; ++n) face += " " + std::to_string(n);
  const Model comb = import_mesh(file("comb.obj", text + "v 0 0 0\n" + face + " " + std::to_string(3 + 3 * teeth)));
  EXPECT_EQ(comb.triangles.size(), std::size_t(3 * teeth + 1));
  EXPECT_NEAR(surface_area(comb), teeth * 1.25, 1e-6 * teeth);
}

TEST_F(Import, RefusesWhatIsNoFile) {
  EXPECT_NE(refusal([&] { import_mesh(folder / "none.ply"); }).find("cannot be read: No such file"), std::string::npos);
  EXPECT_NE(refusal([&] { import_mesh(folder); }).find("folder"), std::string::npos);
  expect_refused("e.ply", "", "is empty");
  expect_refused("e.obj", "", "is empty");
  expect_refused("a.blend", "BLENDER", "are not read; .ply");
}

TEST_F(Import, RefusesBrokenPly) {
  expect_refused("garbage.ply", "\x01\x02hello\nworld\n", "is not a PLY");
  expect_refused("head.ply", tetra_head.substr(0, 60), "no \"end_header\"");
  expect_refused("cut.ply", tetra_head + tetra_vertices + "3 0 2 1\n3 0 1 3\n3 0", "cut short");
  expect_refused("range.ply", tetra_head + tetra_vertices + "3 0 2 1\n3 0 1 4\n3 0 3 2\n3 1 2 3\n",
                 "face 1 names vertex 4, but there are 4");
  expect_refused("negative.ply", tetra_head + tetra_vertices + "3 0 2 -1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
                 "names vertex -1");
  expect_refused("nan.ply", tetra_head + "0 0 0\n1 nan 0\n0 1 0\n0 0 1\n" + tetra_faces, "vertex 1 is (1, nan, 0)");
  expect_refused("huge.ply", tetra_head + "0 0 0\n1 1e99 0\n0 1 0\n0 0 1\n" + tetra_faces, "not a finite place");
  expect_refused("word.ply", tetra_head + "0 0 0\n1 zero 0\n0 1 0\n0 0 1\n" + tetra_faces,
                 "element vertex, row 2: \"zero\" is no number");
  expect_refused("list.ply", tetra_head + tetra_vertices + "3 0 2 1\n3000000000 0 1 3\n3 0 3 2\n",
                 "list of 3000000000");
  std::string absurd = tetra_head + tetra_vertices + tetra_faces;
  absurd.replace(absurd.find("vertex 4"), 8, "vertex 400000000000");
  expect_refused("absurd.ply", absurd, "element vertex claims 400000000000 rows");
  absurd = tetra_head + tetra_vertices + tetra_faces;
  absurd.replace(absurd.find("vertex 4"), 8, "vertex -4");
  expect_refused("minus.ply", absurd, "\"-4\" is no count");
  expect_refused("nofaces.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
                 "z\nend_header\n0 0 0\n",
                 "no faces; a scene takes a cloud of points");
  expect_refused("noz.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
                 "lack x, y or z");
  expect_refused("type.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n0\n",
                 "type \"half\" is not known");
}

TEST_F(Import, RefusesBrokenObj) {
  expect_refused("garbage.obj", "\x01\x02\x03 this is no mesh\n", "garbage.obj");
  expect_refused("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "range.obj");
  expect_refused("e.obj", "v 0 0 " + std::string(400, '9') + "e", "a coordinate that is right is wanted");
  expect_refused("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "nan.obj");
  expect_refused("nofaces.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "nofaces.obj");
}

TEST_F(Import, RefusesBrokenOffStlAndGltf) {
  expect_refused("garbage.off", "hello\n", "is not an OFF");
  expect_refused("absurd.off", "OFF\n4000000000 4 0\n" + tetra_vertices + tetra_faces, "promises 4000000000 vertices");
  expect_refused("range.off", "OFF\n4 4 6\n" + tetra_vertices + "3 0 2 1\n3 0 1 7\n3 0 3 2\n3 1 2 3\n",
                 "face 1 names vertex 7, but there are 4");
  expect_refused("cut.off", "OFF\n4 4 6\n" + tetra_vertices + "3 0 2 1\n3 0 1", "cut short");
  std::string stl(84, '\0');
  const std::uint32_t count = 100000000;
  std::memcpy(stl.data() + 80, &count, 4);
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  expect_refused("deep.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + deep + "}", "more than 100 lists deep");
  expect_refused("absurd.stl", stl + std::string(50, '\0'), "promises 100000000 triangles");
  expect_refused("short.stl", "abc", "cut short");
  expect_refused("cut.stl", "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n", "no endsolid");
  file("range.bin", gltf_bytes({0, 2, 1, 0, 1, 3, 0, 300, 2, 1, 2, 3}));
  expect_refused("range.gltf", gltf_of("range.bin"), "1 of 4 triangles name vertices that are not there");
  expect_refused("cut.gltf", gltf_of("t.bin").substr(0, 300), "cut short at byte");
  expect_refused("garbage.obj", "# a note\nv no number\nand more of no meaning\n",
                 "garbage.obj:2: a coordinate that is right is wanted, not \"no\"");
  expect_refused("garbage.gltf", "{\"asset\":", "cannot be read as a mesh");
  expect_refused("garbage.glb", "glTF\x02", "cannot be read as a mesh");
}

}  // namespace
