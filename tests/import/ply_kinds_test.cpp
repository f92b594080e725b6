// PLY files of other programs that are right, though ours never look so: each is read, as a mesh
// and as points.
#include <gtest/gtest.h>

#include "dreampm/import/import.h"
#include "dreampm/import/point_cloud.h"
#include "geometry/meshes.h"

using namespace dreampm;

namespace {

const std::string tetra =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// `text` with every `from` replaced.
std::string changed(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

class PlyKinds : public InFolder {
 protected:
  void expect_read(const std::string& text) const {
    const auto path = file("t.ply", text);
    const Model mesh = import_mesh(path);
    EXPECT_EQ(mesh.triangles.size(), 4u) << text;
    EXPECT_NEAR(enclosed_volume(mesh), 1.0 / 6, 1e-12) << text;
    EXPECT_TRUE(mesh.warnings.empty()) << text;
    EXPECT_EQ(read_point_cloud(path).size(), 4u) << text;
    EXPECT_FALSE(read_if_cloud(path)) << text;
  }
  void expect_refused(const std::string& text, const std::string& reason) const {
    const auto path = file("t.ply", text);
    for (const std::string& message : {refusal([&] { import_mesh(path); }), refusal([&] { read_point_cloud(path); })})
      EXPECT_NE(message.find(reason), std::string::npos) << message;
  }
};

TEST_F(PlyKinds, HeadersAsOthersWriteThem) {
  expect_read(changed(tetra, "ply\n", "ply \t\n"));
  expect_read(changed(tetra, "format", "obj_info made by hand\nformat"));
  expect_read(changed(tetra, "format", "comment first\n\nformat"));
  expect_read(changed(tetra, "format ascii 1.0", "format  ascii  1.0 "));
  expect_read(changed(tetra, "end_header", "obj_info last\nend_header "));
  expect_read(changed(tetra, "\n", "\r\n"));
  expect_read(changed(tetra, "\n", "\r"));
  expect_read("\xef\xbb\xbf" + tetra);
  expect_read(changed(tetra, "vertex_indices", "vertex_index"));
  std::string edges = changed(tetra, "element face", "element edge 1\nproperty int vertex1\nelement face");
  edges.insert(edges.find("3 0 2 1"), "7\n");
  expect_read(edges);
}

TEST_F(PlyKinds, StripsAreTurnedInTurnAndEndAtMinusOne) {
  // Around the tetrahedron: a strip of two faces, and one more for each of the other two, with a
  // corner named twice.
  const std::string head = changed(changed(tetra, "element face 4", "element tristrips 1"), "uchar int", "int int");
  const std::string strips = head.substr(0, head.find("3 0 2 1"));
  expect_read(strips + "14 2 1 0 3 -1 0 3 2 -1 3 1 1 2 3\n");  // 1 1 2 leads on, turned
  expect_read(strips + "16 2 1 0 3 -1 0 3 2 -1 1 2 3 -1 -1 -1 0\n");
  expect_refused(strips + "3 0 1 4\n", "strip 0 names vertex 4, but there are 4");
  expect_refused(strips + "3 0 1 -2\n", "strip 0 names vertex -2");
  expect_refused(changed(tetra, "3 0 2 1", "3 0 2 -1"), "face 0 names vertex -1");
}

TEST_F(PlyKinds, WhatJoinsVerticesOtherwiseIsRefusedByName) {
  expect_refused(changed(tetra, "element face", "element trifans"), "element \"trifans\" joins vertices in a way");
  expect_refused(changed(tetra, "vertex_indices", "corners"), "element face lacks the list vertex_indices");
  // None of them: a cloud.
  const auto path = file("c.ply", changed(tetra.substr(0, tetra.find("3 0 2 1")), "element face 4", "element face 0"));
  EXPECT_TRUE(read_if_cloud(path));
  EXPECT_EQ(read_point_cloud(path).size(), 4u);
}

TEST_F(PlyKinds, BytesAfterTheLastElementAreAWarning) {
  const Model mesh = import_mesh(file("t.ply", tetra + "more\n"));
  ASSERT_EQ(mesh.warnings.size(), 1u);
  EXPECT_NE(mesh.warnings[0].find("t.ply: 5 bytes follow its last element"), std::string::npos) << mesh.warnings[0];
}

TEST_F(PlyKinds, PolygonsWithInwardCornersAreCutWithinTheirOutline) {
  // An arrow's head, whose fan from corner 0 would reach outside.
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n2 2 0\n0 1 0\n-2 2 0\n";
  for (const char* face : {"4 0 1 2 3\n", "4 1 2 3 0\n", "4 3 0 1 2\n", "4 3 2 1 0\n"}) {
    const Model mesh = import_mesh(file("a.ply", text + face));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_NEAR(surface_area(mesh), 2, 1e-12) << face;
  }
}

}  // namespace
