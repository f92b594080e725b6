// PLY files with something wrong: each is refused with the file's name and what is wrong.
#include "dreampm/io/ply.h"
#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::message_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class PlyDamage : public testing::Test {
 protected:
  fs::path file_ = test::fresh_folder() / "bad.ply";

  std::string header_error(const std::string& text) {
    replace_file_text(file_, text);
    return message_of<InputError>([&] { read_ply_header(file_); });
  }
  std::string particles_error(const std::string& text) {
    replace_file_text(file_, text);
    return message_of<InputError>([&] { read_particles(file_); });
  }
  std::string mesh_error(const std::string& text) {
    replace_file_text(file_, text);
    return message_of<InputError>([&] { read_mesh(file_); });
  }
};

TEST_F(PlyDamage, NoSuchFileFolderEmptyAndGarbage) {
  EXPECT_THAT(message_of<InputError>([&] { read_ply_header(file_); }),
              AllOf(HasSubstr("bad.ply"), HasSubstr("No such file")));
  EXPECT_THAT(message_of<InputError>([&] { read_ply_header(file_.parent_path()); }), HasSubstr("is a folder"));
  EXPECT_THAT(header_error(""), HasSubstr("bad.ply: the file is empty"));
  EXPECT_THAT(header_error("v 0 0 0\nf 1 1 1\n"), HasSubstr("not a PLY file: it starts with \"v 0 0 0\""));
  EXPECT_THAT(header_error("\x01\x02\x03\x1b[2J"), HasSubstr("starts with \"????[2J\""));
  EXPECT_THAT(header_error(std::string(1 << 20, 'x')), HasSubstr("not a PLY file"));
  EXPECT_THAT(header_error(std::string(100, '\0')), HasSubstr("not a PLY file"));
}

TEST_F(PlyDamage, HeadersThatAreWrong) {
  const std::string f = "ply\nformat ascii 1.0\n";
  EXPECT_THAT(header_error("ply\n"), HasSubstr("no \"end_header\""));
  EXPECT_THAT(header_error("ply\nformat ascii 1.0\nelement ver"), HasSubstr("no \"end_header\""));
  EXPECT_THAT(header_error("ply\nend_header\n"), HasSubstr("bad.ply:2: \"end_header\" where \"format\" must stand"));
  EXPECT_THAT(header_error("ply\nformat utf8 1.0\nend_header\n"), HasSubstr("bad.ply:2: format \"utf8\""));
  EXPECT_THAT(header_error("ply\nformat ascii 2.0\nend_header\n"), HasSubstr("version \"2.0\""));
  EXPECT_THAT(header_error(f + "format ascii 1.0\nend_header\n"), HasSubstr("bad.ply:3: a second \"format\""));
  EXPECT_THAT(header_error(f + "wobble\nend_header\n"), HasSubstr("bad.ply:3: \"wobble\" is no PLY header line"));
  EXPECT_THAT(header_error(f + "property float x\nend_header\n"), HasSubstr("a property before any element"));
  EXPECT_THAT(header_error(f + "element vertex many\nend_header\n"), HasSubstr("\"many\" is no count"));
  EXPECT_THAT(header_error(f + "element vertex -3\nend_header\n"), HasSubstr("\"-3\" is no count"));
  EXPECT_THAT(header_error(f + "element vertex 3.5\nend_header\n"), HasSubstr("\"3.5\" is no count"));
  EXPECT_THAT(header_error(f + "element vertex\nend_header\n"), HasSubstr("\"\" is no count"));
  EXPECT_THAT(header_error(f + "element vertex 99999999999999999999\nend_header\n"), HasSubstr("is no count"));
  EXPECT_THAT(header_error(f + "element v 0\nelement v 0\nend_header\n"),
              HasSubstr("bad.ply:4: element v is there twice"));
  EXPECT_THAT(header_error(f + "element v 0\nproperty half x\nend_header\n"), HasSubstr("type \"half\""));
  EXPECT_THAT(header_error(f + "element v 0\nproperty float\nend_header\n"), HasSubstr("names no property"));
  EXPECT_THAT(header_error(f + "element v 0\nproperty float x\nproperty int x\nend_header\n"),
              HasSubstr("bad.ply:5: property x of element v is there twice"));
  EXPECT_THAT(header_error(f + "element f 0\nproperty list float int i\nend_header\n"), HasSubstr("length cannot be"));
}

TEST_F(PlyDamage, AbsurdCountsAreRefusedBeforeAnythingIsAllocated) {
  const std::string b = "ply\nformat binary_little_endian 1.0\n",
                    xyz = "property float x\nproperty float y\nproperty float z\n";
  for (const char* count : {"4000000000", "18446744073709551615", "1537228672809129302", "3"})
    EXPECT_THAT(header_error(b + "element vertex " + count + "\n" + xyz + "end_header\n" + std::string(24, 'x')),
                AllOf(HasSubstr(std::string("claims ") + count), HasSubstr("24 bytes are left")));
  EXPECT_THAT(header_error(b + "element vertex 2\n" + xyz + "element face 9\nproperty list uchar int vertex_indices\n" +
                           "end_header\n" + std::string(24, 'x')),
              HasSubstr("element face claims 9 rows"));
  EXPECT_THAT(header_error(b + "element vertex 12\nend_header\n" + std::string(24, 'x')),
              HasSubstr("has no properties"));
  EXPECT_THAT(header_error("ply\nformat ascii 1.0\nelement vertex 100000000\n" + xyz + "end_header\n0 0 0\n"),
              HasSubstr("claims 100000000"));
  // A list that claims more than there is ends at the end of the file.
  EXPECT_THAT(mesh_error(b + "element vertex 1\n" + xyz + "element face 1\nproperty list uint int other\n" +
                         "property list uchar int vertex_indices\nend_header\n" + std::string(12, '\0') +
                         "\xff\xff\xff\xff\x01\x01"),
              HasSubstr("ends within element face, row 1 of 1"));
}

TEST_F(PlyDamage, EveryTruncationOfParticlesIsFound) {
  ParticleFrame f;
  f.material_names = {"water"};
  f.position.assign(5, {1, 2, 3});
  f.velocity.resize(5);
  f.id.resize(5);
  f.material.resize(5);
  write_particles(file_, f);
  const std::string whole = read_file(file_);
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_THAT(particles_error(whole.substr(0, size)), HasSubstr("bad.ply")) << size;
  EXPECT_THAT(particles_error(whole.substr(0, whole.size() - 1)), HasSubstr("truncated"));
  EXPECT_THAT(particles_error(whole + "x"), HasSubstr("1 bytes follow the last element"));
}

TEST_F(PlyDamage, EveryTruncationOfAMeshIsFound) {
  TriMesh m;
  m.vertices.assign(3, {1, 2, 3});
  m.triangles = {{0, 1, 2}, {2, 1, 0}};
  write_mesh(file_, m);
  const std::string whole = read_file(file_);
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_THAT(mesh_error(whole.substr(0, size)), HasSubstr("bad.ply")) << size;
}

TEST_F(PlyDamage, ParticlesThatMakeNoSense) {
  const auto ascii = [](const std::string& properties, const std::string& rows) {
    std::string text = "ply\nformat ascii 1.0\ncomment material 0 water\nelement vertex 2\n";
    return text + properties + "end_header\n" + rows;
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(particles_error(ascii(xyz, "0 0 0\n0 nan 0\n")), HasSubstr("position of particle 1 is not finite"));
  EXPECT_THAT(particles_error(ascii(xyz, "0 0 0\n0 1e99 0\n")), HasSubstr("not finite"));
  EXPECT_THAT(particles_error(ascii(xyz, "0 0 0\n0 zero 0\n")), HasSubstr("row 2: \"zero\" is no number"));
  EXPECT_THAT(particles_error(ascii(xyz, "0 0 0\n0 1.5x 0\n")), HasSubstr("\"1.5x\""));
  EXPECT_THAT(particles_error(ascii(xyz, "0.00 0.00 0\n0 0\n")), HasSubstr("ends within element vertex, row 2 of 2"));
  EXPECT_THAT(particles_error(ascii(xyz, "0 0 0\n0 0 0\n7\n")), HasSubstr("follow the last element"));
  EXPECT_THAT(particles_error(ascii("property float x\nproperty float y\n", "0 0\n0 0\n")),
              HasSubstr("lacks x, y or z"));
  EXPECT_THAT(particles_error(ascii(xyz + "property float id\n", "0 0 0 1\n0 0 0 1.5\n")),
              HasSubstr("id of particle 1 is 1.5"));
  EXPECT_THAT(particles_error(ascii(xyz + "property int material\n", "0 0 0 1\n0 0 0 256\n")),
              HasSubstr("material of particle 1 is 256"));
  EXPECT_THAT(particles_error(ascii(xyz + "property list uchar int l\n", "0 0 0 0\n0 0 0 0\n")),
              HasSubstr("has a list"));
  EXPECT_THAT(
      particles_error("ply\nformat ascii 1.0\ncomment material x water\nelement vertex 0\n" + xyz + "end_header\n"),
      HasSubstr("comment material NUMBER NAME"));
  EXPECT_THAT(particles_error("ply\nformat ascii 1.0\nelement face 0\nend_header\n"), HasSubstr("no particles"));
}

TEST_F(PlyDamage, MeshesThatMakeNoSense) {
  const auto mesh = [&](const std::string& face_property, const std::string& faces, const std::string& last = "0 1 0") {
    return mesh_error(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty " +
        face_property + "\nend_header\n0 0 0\n1 0 0\n" + last + "\n" + faces + "\n");
  };
  const std::string list = "list uchar int vertex_indices";
  EXPECT_THAT(mesh(list, "3 0 1 3"), HasSubstr("face 0 names vertex 3: 0 to 2 exist"));
  EXPECT_THAT(mesh(list, "3 0 1 -1"), HasSubstr("face 0 names vertex -1"));
  EXPECT_THAT(mesh(list, "3 0 1 1.5"), HasSubstr("names vertex 1.5"));
  EXPECT_THAT(mesh(list, "3 0 1 nan"), HasSubstr("names vertex nan"));
  EXPECT_THAT(mesh(list, "2 0 1"), HasSubstr("face 0 has 2 corners: 3 or 4"));
  EXPECT_THAT(mesh(list, "5 0 1 2 0 1"), HasSubstr("face 0 has 5 corners"));
  EXPECT_THAT(mesh(list, "3 0 1"), HasSubstr("ends within element face"));
  EXPECT_THAT(mesh(list, "3 0 1 2", "0 inf 0"), HasSubstr("vertex 2 is not finite"));
  EXPECT_THAT(mesh("int vertex_indices", "3"), HasSubstr("lacks the list vertex_indices"));
  EXPECT_THAT(mesh("list uchar int corners", "3 0 1 2"), HasSubstr("lacks the list vertex_indices"));
  EXPECT_THAT(mesh_error("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n"),
              HasSubstr("no element \"face\""));
}

}  // namespace
}  // namespace dreampm
