#include "dreampm/import/point_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/meshes.h"

using namespace dreampm;

namespace {

class PointCloud : public InFolder {};

/// Two points, with properties of other types around x y z and a list, an element before, in the
/// byte order asked for.
std::string binary_cloud(bool big) {
  std::string out =
      std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\nobj_info made by hand\nelement camera 1\nproperty double focus\nproperty list uchar short tags\n"
      "element vertex 2\nproperty uchar red\nproperty double x\nproperty float y\nproperty list uint8 "
      "float32 weights\nproperty short z\nend_header\n";
  const auto put = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
  };
  put(35.0), put(std::uint8_t(2)), put(std::int16_t(1)), put(std::int16_t(2));
  for (int i = 0; i < 2; ++i) {
    put(std::uint8_t(10)), put(0.5 + i), put(-1.25f), put(std::uint8_t(i));
    if (i) put(1.0f);
    put(std::int16_t(-300 + i));
  }
  return out;
}

TEST_F(PointCloud, ReadsBinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    const auto points = read_point_cloud(file("c.ply", binary_cloud(big)), 2);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0], (Vec3d{1, -2.5, -600}));
    EXPECT_EQ(points[1], (Vec3d{3, -2.5, -598}));
  }
}

TEST_F(PointCloud, ReadsAsciiWithOtherProperties) {
  const auto points = read_point_cloud(file(
      "c.ply",
      "ply\nformat ascii 1.0\ncomment z first\nelement vertex 2\nproperty float z\nproperty int id\nproperty float "
      "y\nproperty double x\nend_header\n3 7 2 1\n\n  -3.5 8\n+2e0 1e-400"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0], (Vec3d{1, 2, 3}));
  EXPECT_EQ(points[1], (Vec3d{0, 2, -3.5}));
}

TEST_F(PointCloud, ReadsVelocitiesWhereThereAreAny) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const MovingCloud still = read_moving_cloud(file("s.ply", head + "end_header\n1 2 3\n"));
  EXPECT_TRUE(still.velocities.empty());
  const std::string three = "property float vz\nproperty float vx\nproperty float vy\nend_header\n";
  const MovingCloud moving = read_moving_cloud(file("m.ply", head + three + "1 2 3 6 4 5\n"), 2);
  EXPECT_EQ(moving.points.at(0), (Vec3d{2, 4, 6}));
  EXPECT_EQ(moving.velocities.at(0), (Vec3d{8, 10, 12}));
  const auto bad = file("b.ply", head + three + "1 2 3 6 inf 5\n");
  EXPECT_NE(refusal([&] { read_moving_cloud(bad); }).find("velocity of vertex 0 is not finite"), std::string::npos);
}

TEST_F(PointCloud, RefusesWhatIsBroken) {
  const auto refused = [&](const std::string& content, const std::string& reason) {
    const auto path = file("bad.ply", content);
    const std::string text = refusal([&] { read_point_cloud(path); });
    EXPECT_NE(text.find(reason), std::string::npos) << text;
    EXPECT_NE(text.find("bad.ply"), std::string::npos) << text;
  };
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  refused("", "is empty");
  refused("x y z\n1 2 3\n", "is not a PLY");
  refused(head + std::string(35, '\0'), "element vertex claims 3 rows of at least 12 bytes, but 35 bytes are left");
  const float bad[9] = {0, 0, 0, 0, std::nanf(""), 0, 0, 0, 0};
  refused(head + std::string(reinterpret_cast<const char*>(bad), 36), "vertex 1 is (0, nan, 0)");
  const std::string cut = binary_cloud(false);
  refused(cut.substr(0, cut.size() - 1), "cut short");
  refused("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
          "no points");
  refused("ply\nformat ascii 1.0\nend_header\n", "no element \"vertex\"");
  refused("ply\nformat morse 1.0\nend_header\n", "format \"morse\" is not known");
  refused("ply\nelement vertex 1\nend_header\n", "\"element vertex 1\" where \"format\" must stand");
  EXPECT_NE(refusal([&] { read_point_cloud(folder / "none.ply"); }).find("No such file"), std::string::npos);
  const auto good = file("good.ply", binary_cloud(false));
  EXPECT_NE(refusal([&] { read_point_cloud(good, 0); }).find("scale of 0"), std::string::npos);
}

TEST_F(PointCloud, SurvivesEveryCutAndEveryFlippedByte) {
  const std::string whole = binary_cloud(false);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const auto path = file("cut.ply", whole.substr(0, n));
    EXPECT_THROW(read_point_cloud(path), InputError) << n;
    std::string flipped = whole;
    flipped[n] = static_cast<char>(flipped[n] ^ 0xff);
    try {
      EXPECT_LE(read_point_cloud(file("flip.ply", flipped)).size(), 2u);
    } catch (const InputError&) {  // either is right, as long as it ends
    }
  }
}

}  // namespace
