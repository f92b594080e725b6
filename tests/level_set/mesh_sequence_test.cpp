// Meshes that deform.
#include "dreampm/level_set/mesh_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "thrown.h"

namespace dreampm::mesh_sequence_test {
namespace {
using testing::HasSubstr;

class MeshSequences : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  /// A box as an OBJ file; its top lies at `top`, `shift` along x.
  std::string box(const std::string& name, double top, double shift, bool cut = false) const {
    const auto file = folder / name;
    std::ofstream out(file);
    for (int n = 0; n < 8; ++n)
      out << "v " << (n & 1 ? 0.6 : 0) + shift << ' ' << (n & 2 ? top : 0) << ' ' << (n & 4 ? 0.4 : 0) << '\n';
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n";
    if (!cut) out << "f 2 4 8 6\n";
    return file.string();
  }
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("dreampm_sequence_" + std::to_string(::getpid()));
};

// The top of a box rises by ten voxels from file to file: its surface is where the vertices are in
// between, and moves as they do.
TEST_F(MeshSequences, SurfacesMoveBetweenFiles) {
  const std::vector<std::string> files{box("a.obj", 0.2, 0), box("b.obj", 0.4, 0), box("c.obj", 0.4, 0.1)};
  const MeshSequence sequence(files, 10, 1, 0.02, 0.06);
  for (const double time : {0.0, 0.013, 0.05, 0.0871}) {
    const double top = 0.2 + 2 * time;
    const auto region = sequence.at(time);
    for (const double off : {-0.02, 0.0, 0.03})
      EXPECT_NEAR(region->distance({0.31, top + off, 0.17}), off, 1e-3) << time;
    EXPECT_GT(region->normal({0.31, top + 0.01, 0.17}).y, 0.999);
    EXPECT_NEAR(sequence.velocity({0.31, top, 0.17}, time).y, 2, 1e-9) << time;
    // A side stretches: half-way up it is half as fast.
    EXPECT_NEAR(sequence.velocity({0, top / 2, 0.17}, time).y, 1, 0.02) << time;
  }
  EXPECT_NEAR(sequence.velocity({0.35, 0.4, 0.2}, 0.15).x, 1, 1e-9);
  EXPECT_NEAR(sequence.at(0.15)->distance({0.05, 0.2, 0.2}), 0, 1e-3);
  EXPECT_EQ(sequence.velocity({0.35, 0.4, 0.2}, 0.2), Vec3d{});
  EXPECT_NEAR(sequence.at(1)->distance({0.1, 0.2, 0.2}), 0, 1e-3);
  EXPECT_NEAR(sequence.fastest(0, 0.3), 2, 1e-9);
  EXPECT_NEAR(sequence.fastest(0.11, 0.3), 1, 1e-9);
  EXPECT_EQ(sequence.fastest(0.2, 0.3), 0);
  EXPECT_NEAR(sequence.farthest(0.05, 0.15), 0.1 + 0.05, 1e-9);
}

TEST_F(MeshSequences, KeepTheirTopology) {
  const std::vector<std::string> files{box("a.obj", 0.2, 0), box("b.obj", 0.4, 0, true)};
  EXPECT_THAT(test::refusal([&] { MeshSequence(files, 10, 1, 0.02, 0.06); }),
              HasSubstr("b.obj: has 8 vertices and 10 triangles that are not those of"));
}

}  // namespace
}  // namespace dreampm::mesh_sequence_test
