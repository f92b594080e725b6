#include "dreampm/io/ply.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::message_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

ParticleFrame sample(std::size_t n) {
  ParticleFrame f;
  f.material_names = {"water", "red jelly"};
  for (std::size_t i = 0; i < n; ++i) {
    const auto t = static_cast<float>(i) + 0.1f;
    f.position.push_back({t, -t / 3, 1e-30f * t});
    f.velocity.push_back({-0.0f, t * t, 1 / t});
    f.id.push_back(static_cast<std::int32_t>(7 * i));
    f.material.push_back(static_cast<std::uint8_t>(i % 2));
  }
  return f;
}

void expect_equal(const ParticleFrame& a, const ParticleFrame& b) {
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.material_names, b.material_names);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.color, b.color);
}

TEST(Particles, ComeBackFromTheirFile) {
  const fs::path file = test::fresh_folder() / "particles_000001.ply";
  ParticleFrame f = sample(1000);
  write_particles(file, f);
  expect_equal(read_particles(file), f);
  for (const char* name : {"f_00", "f_22", "jp", "density"}) f.columns[name] = std::vector<float>(1000, 0.1f);
  f.columns["jp"][999] = -std::numeric_limits<float>::infinity();
  f.color.assign(1000, {1, 2, 3, 4});
  write_particles(file, f);
  expect_equal(read_particles(file), f);
}

TEST(Particles, SayWhereTheyCountFrom) {
  const fs::path file = test::fresh_folder() / "p.ply";
  ParticleFrame f = sample(3);
  write_particles(file, f);
  const std::string plain = read_file(file);
  f.shift = {500000.1, 0, -1.0 / 3};
  write_particles(file, f);
  const ParticleFrame back = read_particles(file);
  EXPECT_EQ(back.shift, f.shift) << "to the last digit";
  EXPECT_EQ(back.position, f.position);
  std::string text = read_file(file);
  const std::string line = "comment shift 500000.1 0 -0.3333333333333333\n";
  ASSERT_THAT(text, HasSubstr(line));
  text.erase(text.find(line), line.size());
  EXPECT_EQ(text, plain) << "nothing else changes";
  for (const char* broken : {"comment shift 1 2\n", "comment shift 1 2 x\n", "comment shift 1 nan 3\n"}) {
    std::string other = plain;
    replace_file_text(file, other.insert(other.find("element"), broken));
    EXPECT_THAT(message_of<InputError>([&] { read_particles(file); }),
                HasSubstr("does not read \"comment shift X Y Z\""))
        << broken;
  }
}

TEST(Particles, TheFileReadsAsTheFormatSays) {
  const fs::path file = test::fresh_folder() / "p.ply";
  write_particles(file, sample(3));
  const std::string text = read_file(file);
  const std::string head =
      "ply\nformat binary_little_endian 1.0\ncomment dreampm particles, SI units, Y up\n"
      "comment material 0 water\ncomment material 1 red jelly\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nproperty float vx\nproperty float vy\nproperty float vz\n"
      "property int id\nproperty uchar material\nend_header\n";
  EXPECT_THAT(text, StartsWith(head));
  EXPECT_EQ(text.size(), head.size() + 3 * 29);
}

TEST(Particles, NoneIsAFrameToo) {
  const fs::path file = test::fresh_folder() / "p.ply";
  ParticleFrame f;
  f.material_names = {"water"};
  write_particles(file, f);
  expect_equal(read_particles(file), f);
}

TEST(Particles, AsciiAndOtherTypesAndOrders) {
  const fs::path file = test::fresh_folder() / "p.ply";
  replace_file_text(file,
                    "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info none\r\nelement vertex 2\r\n"
                    "property double z\r\nproperty float32 y\r\nproperty int16 x\r\nproperty uchar red\r\n"
                    "property uchar green\r\nproperty uchar blue\r\nproperty float heat\r\nend_header\r\n"
                    "0.5 1e-3 -4 1 2 3 nan\r\n7 8 9 255 0 0 1.5");
  const ParticleFrame f = read_particles(file);
  EXPECT_EQ(f.position, (std::vector<Vec3f>{{-4, 1e-3f, 0.5f}, {9, 8, 7}}));
  EXPECT_EQ(f.velocity, (std::vector<Vec3f>(2)));
  EXPECT_THAT(f.id, ElementsAre(0, 1));
  EXPECT_TRUE(std::isnan(f.columns.at("heat")[0]));
  EXPECT_EQ(f.columns.at("heat")[1], 1.5f);
  EXPECT_EQ(f.color[1], (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
}

TEST(Particles, BigEndianAndCoordinatesInDouble) {
  const fs::path file = test::fresh_folder() / "p.ply";
  std::string text =
      "ply\nformat binary_big_endian 1.0\nelement vertex 2\nproperty double x\nproperty float y\nproperty short z\n"
      "property int id\nproperty uchar material\nend_header\n";
  const auto put = [&](auto value) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    text.append(bytes.rbegin(), bytes.rend());
  };
  for (int i = 0; i < 2; ++i)
    put(0.5 + i), put(-1.25f), put(std::int16_t(-300)), put(std::int32_t(70000 + i)), text += '\0';
  replace_file_text(file, text);
  const ParticleFrame f = read_particles(file);
  EXPECT_EQ(f.position, (std::vector<Vec3f>{{0.5f, -1.25f, -300}, {1.5f, -1.25f, -300}}));
  EXPECT_THAT(f.id, ElementsAre(70000, 70001));

  ParticleFrame far = sample(2);
  far.exact = {{500000.0625, 1, 2}, {500000.125, 3, 4}};
  write_particles(file, far);
  EXPECT_THAT(read_file(file),
              HasSubstr("property double x\nproperty double y\nproperty double z\nproperty float vx\n"));
  const ParticleFrame back = read_particles(file);
  EXPECT_EQ(back.position[1], (Vec3f{500000.125f, 3, 4}));
  EXPECT_EQ(back.velocity, far.velocity);
}

TEST(Particles, AFrameThatDoesNotFitTogetherIsRefused) {
  const fs::path folder = test::fresh_folder(), file = folder / "p.ply";
  const auto error = [&](const auto& change) {
    ParticleFrame f = sample(4);
    change(f);
    return message_of<InputError>([&] { write_particles(file, f); });
  };
  EXPECT_THAT(error([](auto& f) { f.velocity.pop_back(); }), HasSubstr("4 positions but 3 values of velocity"));
  EXPECT_THAT(error([](auto& f) { f.id.clear(); }), HasSubstr("0 values of id"));
  EXPECT_THAT(error([](auto& f) { f.columns["jp"] = {1.0f}; }), HasSubstr("1 values of jp"));
  EXPECT_THAT(error([](auto& f) { f.columns["two words"].resize(4); }), HasSubstr("\"two words\""));
  EXPECT_THAT(error([](auto& f) { f.columns["x"].resize(4); }), HasSubstr("\"x\" cannot name a column"));
  EXPECT_THAT(error([](auto& f) { f.material[2] = 2; }), HasSubstr("particle 2 is of material 2"));
  EXPECT_THAT(error([](auto& f) { f.material_names[0] = "a\nelement face 3"; }), HasSubstr("cannot name a material"));
  EXPECT_EQ(test::files_in(folder), 0u);
}

TEST(Particles, AFullDiskIsAnErrorWithItsReasonAndLeavesNothing) {
  const fs::path folder = test::fresh_folder();
  const ParticleFrame f = sample(200000);  // 5.8 MB, more than one piece
  const std::size_t before = test::open_descriptors();
  for (const rlim_t limit : {0, 10, 100000, 5000000}) {
    const test::FileSizeLimit small(limit);
    EXPECT_THAT(message_of<RunError>([&] { write_particles(folder / "p.ply", f); }),
                AllOf(HasSubstr("p.ply: cannot be written"), HasSubstr("File too large")));
    EXPECT_EQ(test::files_in(folder), 0u);
  }
  EXPECT_EQ(test::open_descriptors(), before);
  EXPECT_THAT(message_of<RunError>([&] { write_particles(folder / "none" / "p.ply", f); }), HasSubstr("No such file"));
}

TriMesh tetrahedron() {
  TriMesh m;
  m.vertices = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f}};
  m.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return m;
}

TEST(Mesh, ComesBackFromItsFile) {
  const fs::path file = test::fresh_folder() / "surface_000001.ply";
  TriMesh m = tetrahedron();
  for (int round = 0; round < 3; ++round) {
    if (round > 0) m.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0.6f, 0.8f, 0}};
    if (round > 1) m.velocities = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {-0.1f, 0, 1e-20f}};
    write_mesh(file, m);
    const TriMesh back = read_mesh(file);
    EXPECT_EQ(back.vertices, m.vertices);
    EXPECT_EQ(back.triangles, m.triangles);
    EXPECT_EQ(back.normals, m.normals);
    EXPECT_EQ(back.velocities, m.velocities);
  }
  write_mesh(file, {});
  EXPECT_TRUE(read_mesh(file).vertices.empty());
}

TEST(Mesh, AttributesComeBackFromTheirFile) {
  const fs::path file = test::fresh_folder() / "m.ply";
  TriMesh m = tetrahedron();
  m.velocities = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {-0.1f, 0, 1e-20f}};
  const VertexAttributes given{{"age", AttributeKind::number, {0, 0.25f, 1e-20f, 1.0f / 3}},
                               {"color", AttributeKind::color, {1, 0, 0, 0, 0.5f, 0.02f, 0.2f, 0.2f, 0.2f, 0, 0, 1}},
                               {"source", AttributeKind::whole, {0, -1, 65535, 3}},
                               {"vorticity", AttributeKind::vector, {1, 2, 3, 4, 5, 6, 7, 8, 9, -1, -2, -3}}};
  write_mesh(file, m, {}, si_note, given);
  VertexAttributes got;
  EXPECT_EQ(read_mesh(file, &got).velocities, m.velocities);
  ASSERT_EQ(got.size(), given.size());
  for (std::size_t a = 0; a < given.size(); ++a) {
    EXPECT_EQ(got[a].name, given[a].name);
    EXPECT_EQ(got[a].kind, given[a].kind) << given[a].name;
    if (given[a].kind != AttributeKind::color) {
      EXPECT_EQ(got[a].values, given[a].values) << given[a].name;
      continue;
    }
    for (std::size_t i = 0; i < given[a].values.size(); ++i)  // bytes of sRGB: half a step of 1/255, in light
      EXPECT_NEAR(got[a].values[i], given[a].values[i], 0.5f / 255 * 2.3f) << i;
  }
  // Who does not ask for them reads the same mesh.
  EXPECT_EQ(read_mesh(file).vertices, m.vertices);
  EXPECT_THAT(
      message_of<InputError>([&] { write_mesh(file, m, {}, si_note, {{"age", AttributeKind::number, {0, 1}}}); }),
      HasSubstr("4 vertices but 2 numbers of age"));
}

TEST(Mesh, AttributesOfOthersAreRead) {
  const fs::path file = test::fresh_folder() / "m.ply";
  replace_file_text(file,
                    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                    "property float red\nproperty float green\nproperty float blue\nproperty double heat\n"
                    "property ushort region\nproperty float flow_x\nelement face 0\n"
                    "property list uchar uint vertex_index\nend_header\n0 0 0 1 0 0.5 37.5 12 4\n");
  VertexAttributes got;
  read_mesh(file, &got);
  ASSERT_EQ(got.size(), 4u);
  EXPECT_EQ(got[0].kind, AttributeKind::color);
  EXPECT_NEAR(got[0].values[2], 0.2140f, 1e-4f);
  EXPECT_EQ(got[1].name, "heat");
  EXPECT_EQ(got[1].values[0], 37.5f);
  EXPECT_EQ(got[2].kind, AttributeKind::whole);
  EXPECT_EQ(got[3].name, "flow_x") << "a vector needs all three";
}

TEST(Mesh, QuadsAndOtherElementsAreRead) {
  const fs::path file = test::fresh_folder() / "m.ply";
  replace_file_text(file,
                    "ply\nformat ascii 1.0\nelement camera 1\nproperty float fov\nproperty list uchar int tags\n"
                    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 2\nproperty uchar flag\nproperty list uchar uint vertex_index\nend_header\n"
                    "50 2 8 9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 4 0 1 2 3\n0 3 0 1 2\n\n");
  const TriMesh m = read_mesh(file);
  EXPECT_EQ(m.vertices.size(), 4u);
  EXPECT_EQ(m.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
}

TEST(Mesh, AMeshThatDoesNotFitTogetherIsRefused) {
  const fs::path folder = test::fresh_folder();
  const auto error = [&](const auto& change) {
    TriMesh m = tetrahedron();
    change(m);
    return message_of<InputError>([&] { write_mesh(folder / "m.ply", m); });
  };
  EXPECT_THAT(error([](auto& m) { m.normals.resize(3); }), HasSubstr("4 vertices but 3 normals"));
  EXPECT_THAT(error([](auto& m) { m.velocities.resize(5); }), HasSubstr("5 velocities"));
  EXPECT_THAT(error([](auto& m) { m.triangles[3][1] = 4; }), HasSubstr("triangle 3 names vertex 4 of 4"));
  EXPECT_EQ(test::files_in(folder), 0u);
}

TEST(Mesh, ObjHoldsTheColorBehindThePlaces) {
  const fs::path file = test::fresh_folder() / "m.obj";
  write_obj(file, tetrahedron(), {}, si_note,
            {{"color", AttributeKind::color, {1, 0, 0, 0, 0.2140f, 0, 0, 0, 1, 1, 1, 1}},
             {"age", AttributeKind::number, {1, 2, 3, 4}}});
  const std::string text = read_file(file);
  EXPECT_THAT(text, HasSubstr("v 0 0 0 1.0000 0.0000 0.0000\nv 0.1 0 0 0.0000 0.5000 0.0000\n"));
}

TEST(Mesh, ObjHoldsTheSameNumbers) {
  const fs::path file = test::fresh_folder() / "m.obj";
  TriMesh m = tetrahedron();
  m.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0.6f, 0.8f, 0}};
  write_obj(file, m);
  std::istringstream in(read_file(file));
  TriMesh back;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    Vec3f v;
    if (kind == "v" && words >> v.x >> v.y >> v.z) back.vertices.push_back(v);
    if (kind == "vn" && words >> v.x >> v.y >> v.z) back.normals.push_back(v);
    if (kind != "f") continue;
    std::array<std::uint32_t, 3> t{};
    for (std::uint32_t& i : t) {
      std::string corner;
      words >> corner;
      std::uint32_t a = 0, n = 0;
      ASSERT_EQ(std::sscanf(corner.c_str(), "%u//%u", &a, &n), 2) << line;
      EXPECT_EQ(a, n);
      i = a - 1;
    }
    back.triangles.push_back(t);
  }
  EXPECT_EQ(back.vertices, m.vertices);
  EXPECT_EQ(back.normals, m.normals);
  EXPECT_EQ(back.triangles, m.triangles);
}

TEST(Mesh, AFullDiskLeavesNothing) {
  const fs::path folder = test::fresh_folder();
  const test::FileSizeLimit small(200);
  EXPECT_THAT(message_of<RunError>([&] { write_mesh(folder / "m.ply", tetrahedron()); }), HasSubstr("File too large"));
  EXPECT_THAT(message_of<RunError>([&] {
                TriMesh m = tetrahedron();
                for (int i = 0; i < 50; ++i) m.triangles.push_back({0, 1, 2});
                write_obj(folder / "m.obj", m);
              }),
              HasSubstr("File too large"));
  EXPECT_EQ(test::files_in(folder), 0u);
}

}  // namespace
}  // namespace dreampm
