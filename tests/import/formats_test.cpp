// STL, OBJ and glTF as they are found, not as the standards would have them.
#include <cstring>

#include "dreampm/base/file.h"
#include "dreampm/geometry/alike.h"
#include "dreampm/import/import.h"
#include "dreampm/import/obj.h"
#include "dreampm/import/off.h"
#include "dreampm/import/ply.h"
#include "dreampm/import/stl.h"
#include "dreampm/level_set/level_set.h"
#include "geometry/meshes.h"

using namespace dreampm;

namespace {

class Formats : public InFolder {
 protected:
  Model expect_tetrahedron(const std::string& name, const std::string& text, const std::string& warning = "") const {
    const Model mesh = import_mesh(file(name, text));
    EXPECT_EQ(mesh.vertices.size(), 4u) << text;
    EXPECT_EQ(mesh.triangles.size(), 4u) << text;
    EXPECT_NEAR(enclosed_volume(mesh), 1.0 / 6, 1e-6) << text;
    EXPECT_EQ(mesh.warnings.size(), warning.empty() ? 0u : 1u) << text;
    if (!warning.empty() && !mesh.warnings.empty()) {
      EXPECT_NE(mesh.warnings[0].find(warning), std::string::npos) << mesh.warnings[0];
    }
    return mesh;
  }
  void expect_refused(const std::string& name, const std::string& text, const std::string& reason) const {
    const auto path = file(name, text);
    const std::string message = refusal([&] { import_mesh(path); });
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_NE(message.find(name), std::string::npos) << message;
  }
};

constexpr int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
constexpr float places[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::string ascii_stl() {
  std::string text = "solid a tetrahedron\n";
  for (const auto& f : faces) {
    text += "  facet normal nan nan nan\n    outer loop\n";
    for (const int v : f) text += fmt::format("      vertex {} {} {}\n", places[v][0], places[v][1], places[v][2]);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid a tetrahedron\n";
}

std::string binary_stl(const std::string& comment, std::uint32_t count = 4) {
  std::string text = comment;
  text.resize(80);
  text.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& f : faces) {
    text.append(12, '\0');
    for (const int v : f) text.append(reinterpret_cast<const char*>(places[v]), 12);
    text.append(2, '\0');
  }
  return text;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

TEST_F(Formats, AsciiStl) {
  const std::string text = ascii_stl();
  expect_tetrahedron("t.stl", text);
  expect_tetrahedron("t.stl", " " + text);
  expect_tetrahedron("t.stl", "\n \n" + text);
  expect_tetrahedron("t.stl", "\xef\xbb\xbf" + text);
  expect_tetrahedron("t.STL", upper(text));
  std::string other = text;
  for (std::size_t at = 0; (at = other.find('\n', at)) != other.npos; at += 2) other.replace(at, 1, "\r\n");
  expect_tetrahedron("t.stl", other);
  // Two solids in one file.
  const std::size_t half = text.find("  facet", text.find("endfacet"));
  expect_tetrahedron("t.stl", text.substr(0, half) + "endsolid\nsolid\n" + text.substr(half));
  for (const std::size_t less : {23u, 25u, 60u})
    expect_refused("cut.stl", text.substr(0, text.size() - less), "cut short: it has no endsolid");
  expect_refused("cut.stl", text.substr(0, text.find("vertex 0 1 0")), "cut short: it has no endsolid");
  other = text;
  other.replace(other.find("endloop"), 7, "endlop");
  expect_refused("typo.stl", other, "typo.stl:7: \"endlop\" where \"endloop\" must stand");
  other = text;
  other.replace(other.find("vertex 0 1 0"), 12, "vertex 0 one 0");
  expect_refused("word.stl", other, "word.stl:5: a coordinate that is right is wanted, not \"one\"");
  other.replace(other.find("one"), 3, "nan");
  expect_refused("nan.stl", other, "not a finite place");
}

TEST_F(Formats, BinaryStl) {
  expect_tetrahedron("t.stl", binary_stl("made by hand"));
  expect_tetrahedron("t.stl", binary_stl("solid as some programs begin"));
  expect_tetrahedron("t.stl", binary_stl("made by hand") + "xx", "t.stl: 2 bytes follow the 4 triangles");
  expect_tetrahedron("t.stl", binary_stl("solid") + std::string(300, '\n'), "300 bytes follow the 4 triangles");
  const std::string whole = binary_stl("made by hand");
  for (const std::size_t size : {84u, 100u, 283u})
    expect_refused("cut.stl", whole.substr(0, size), "promises 4 triangles, which take 284 bytes");
  expect_refused("none.stl", binary_stl("made by hand", 0), "promises 0 triangles");
}

const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(Formats, Obj) {
  expect_tetrahedron("t.OBJ", obj);
  expect_tetrahedron("t.obj",
                     "\xef\xbb\xbf# a comment\r\nmtllib none.mtl\r\no t\r\ns off\r\nl 1 2\r\n" + obj.substr(0, 32) +
                         "f -4 -2 -3\nf 1/1/1 2//7 4/2 # here\nf 1 \\\n 4 3\nvn 0 0 1\nusemtl red\nfo 2 3 4\n");
  expect_refused("range.obj", obj + "f 1 2 5\n", "range.obj:9: a face names vertex 5, but 4 are there so far");
  expect_refused("zero.obj", obj + "f 0 1 2\n", "names vertex 0");
  expect_refused("back.obj", obj + "f -5 1 2\n", "names vertex -5");
  expect_refused("word.obj", obj + "f a b c\n", "word.obj:9: the index of a vertex that is right is wanted, not \"a\"");
  expect_refused("short.obj", "v 1 2\n" + obj, "short.obj:1: the line is cut short");
  expect_refused("points.obj", obj.substr(0, 32), "no faces; clouds of points are read from .ply");
}

/// `extra` is text for the file's top level; the buffer's URI is `uri`.
std::string gltf(const std::string& uri, const std::string& extra = "") {
  return R"({"asset":{"version":"2.0"},)" + extra + R"("scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "buffers":[{"uri":")" +
         uri + R"(","byteLength":72}],"bufferViews":[{"buffer":0,"byteLength":48},
    {"buffer":0,"byteOffset":48,"byteLength":24}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,
    "type":"VEC3","min":[0,0,0],"max":[1,1,1]},{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

TEST_F(Formats, GltfNamesItsBuffersAsUris) {
  std::string bytes(reinterpret_cast<const char*>(places), sizeof places);
  for (const auto& f : faces)
    for (const int v : f) bytes += {static_cast<char>(v), '\0'};
  file("my file.bin", bytes);
  expect_tetrahedron("t.gltf", gltf("my%20file.bin"));
  expect_tetrahedron("t.gltf", gltf("my file.bin"));
  std::filesystem::create_directories(folder / "a%20b" / "päth");
  std::ofstream(folder / "a%20b" / "päth" / "50%.bin", std::ios::binary) << bytes;
  expect_tetrahedron("a%20b/t.GLTF", gltf("p%C3%A4th/50%25.bin"));
  expect_refused("none.gltf", gltf("no%20file.bin"), "cannot be read as a mesh");
}

TEST_F(Formats, GltfExtensionsThatMoveVerticesAreRefusedByName) {
  const auto required = [](const std::string& names) {
    return gltf("t.bin", "\"extensionsUsed\":[" + names + "],\"extensionsRequired\":[" + names + "],");
  };
  const auto refused = [&](const std::string& name, const std::string& remedy) {
    expect_refused("t.gltf", required("\"" + name + "\""), "t.gltf: uses " + name + ", which is not read; " + remedy);
  };
  refused("KHR_draco_mesh_compression", "export it without compression");
  refused("EXT_meshopt_compression", "export it without compression");
  refused("KHR_mesh_quantization", "export it without quantization");
  refused("EXT_mesh_gpu_instancing", "export it without that extension");
  // A compressed or quantized file is found, whether the file says so or not.
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  expect_refused("q.gltf", changed(gltf("t.bin"), "5126", "5122"), "uses KHR_mesh_quantization, which is not read");
  expect_refused("d.gltf",
                 changed(changed(gltf("t.bin"), "\"indices\":1",
                                 R"("indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}})"),
                         "\"bufferView\":0,\"componentType\"", "\"componentType\""),
                 "uses KHR_draco_mesh_compression, which is not read");
  expect_refused(
      "m.gltf",
      changed(gltf("t.bin"), "\"uri\":\"t.bin\"", R"("extensions":{"EXT_meshopt_compression":{"fallback":true}})"),
      "uses EXT_meshopt_compression, which is not read");
  std::string bytes(reinterpret_cast<const char*>(places), sizeof places);
  for (const auto& f : faces)
    for (const int v : f) bytes += {static_cast<char>(v), '\0'};
  file("t.bin", bytes);
  expect_tetrahedron("t.gltf", required(R"("KHR_materials_unlit","KHR_texture_transform")"));
}

/// A ball of 0.25 m as a map has it, 500 km east and 4000 km north.
TEST_F(Formats, MeshesAtMapCoordinatesKeepTheirDigits) {
  const Vec3d place{500000.125, 4000000.5, 120};
  const TriMesh ball = sphere_mesh(0.25, 3);
  std::string text, ply = fmt::format(
                        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty "
                        "double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
                        ball.vertices.size(), ball.triangles.size());
  std::string off = fmt::format("OFF\n{} {} 0\n", ball.vertices.size(), ball.triangles.size());
  std::string stl = "solid\n";
  const auto line = [&](std::uint32_t v) {
    const Vec3d p = place + Vec3d(ball.vertices[v]);
    return fmt::format("{:.9f} {:.9f} {:.9f}\n", p.x, p.y, p.z);
  };
  for (std::uint32_t v = 0; v < ball.vertices.size(); ++v) text += "v " + line(v), ply += line(v), off += line(v);
  for (const auto& [a, b, c] : ball.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    ply += fmt::format("3 {} {} {}\n", a, b, c), off += fmt::format("3 {} {} {}\n", a, b, c);
    stl += "facet normal 0 0 0\nouter loop\nvertex " + line(a) + "vertex " + line(b) + "vertex " + line(c) +
           "endloop\nendfacet\n";
  }
  constexpr double h = 0.02;
  const auto near = mesh_region(ball, h, "ball");
  for (const auto& [name, content] :
       {std::pair("b.obj", text), {"b.ply", ply}, {"b.off", off}, {"b.stl", stl + "endsolid\n"}}) {
    const auto far = mesh_regions()({file(name, content).string(), {}, {}}, h, 0);
    EXPECT_NEAR(level_set_volume(*far), level_set_volume(*near), 1e-6 * level_set_volume(*near)) << name;
    for (double x = -0.3; x < 0.3; x += 0.017) {
      const Vec3d p{x, 0.04, -0.07};
      EXPECT_NEAR(far->distance(p + place), near->distance(p), 1e-6) << name;
    }
    EXPECT_NEAR(length(far->bounds().center() - place), 0, 1e-8) << name;
  }
}

/// Whatever is wrong with a file, it is refused as input, or read; nothing else happens.
TEST_F(Formats, SurviveEveryCutAndEveryFlippedByte) {
  const std::string
      off = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
      ply =
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
          "0 0 0\n1 0 0\n0 1 0\n4 0 1 2 -1\n";
  const auto survives = [](Model (*parse)(std::string_view, const std::string&), const std::string& text) {
    try {
      Model model = parse(text, "some.file");
      for (const auto& t : model.triangles)
        for (const std::uint32_t v : t) ASSERT_LT(v, model.vertices.size());
      require_finite(model, "some.file");
      turn_alike(model);
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("some.file"), std::string::npos) << e.what();
    }
  };
  for (const auto& [parse, text] : {std::pair(&parse_obj, obj), std::pair(&parse_off, off), std::pair(&parse_ply, ply),
                                    std::pair(&parse_stl, ascii_stl()), std::pair(&parse_stl, binary_stl("by hand"))})
    for (std::size_t n = 0; n < text.size(); ++n) {
      survives(parse, text.substr(0, n));
      std::string flipped = text;
      for (const int bits : {0xff, 0x10, 0x01}) {
        flipped[n] = static_cast<char>(text[n] ^ bits);
        survives(parse, flipped);
      }
    }
}

}  // namespace
