// The looks "water" and "skin", by what any driver has to agree on.
#include <cmath>

#include "canvas.h"
#include "dreampm/math/rng.h"

namespace dreampm::gl {
namespace {
using test::brightness;
using test::changed_pixels;
using test::filled;
using test::pixel;

struct Surface : test::Drawing {
  static constexpr float spacing = 0.02f;

  static ParticleBatch water(std::span<const Vec3f> at) {
    ParticleBatch b;
    b.position = at;
    b.spacing = spacing;
    b.radius = 0.8f * spacing;
    b.look = "water";
    return b;
  }
  /// Straight down on a pool in the middle of the floor.
  static Camera above() { return {{0.5f, 1.8f, 0.51f}, {0.5f, 0, 0.5f}}; }
  static RgbImage pool(float depth, const Liquid& liquid = {}) {
    std::vector<Vec3f> at = filled({{0.2f, 0, 0.2f}, {0.8f, depth, 0.8f}}, spacing);
    std::uint64_t n = 0;  // off the lattice, as matter that has moved is
    for (Vec3f& p : at)
      for (int axis = 0; axis < 3; ++axis) p[axis] += 0.6f * spacing * static_cast<float>(uniform(7, n++) - 0.5);
    ParticleBatch batch = water(at);
    batch.liquid = liquid;
    Picture picture;
    picture.particles = {&batch, 1};
    return drawn(picture, above());
  }
};

TEST_F(Surface, DeeperIsDarkerAndBluer) {
  Liquid clear;  // nothing but absorption
  clear.cloudiness = 0;
  const RgbImage shallow = pool(0.06f, clear), deep = pool(0.3f, clear);
  int darker = 0, bluer = 0, all = 0;
  for (int y = 108; y < 148; ++y)
    for (int x = 108; x < 148; ++x, ++all) {
      const auto a = pixel(shallow, x, y), b = pixel(deep, x, y);
      darker += b[0] < a[0];
      bluer += b[2] * a[0] > a[2] * b[0];
    }
  EXPECT_GT(darker, 0.95 * all);
  EXPECT_GT(bluer, 0.95 * all);
}

TEST_F(Surface, AFlatPoolIsSmoothAndHasNoHoles) {
  Liquid milk;  // the floor's pattern does not show
  milk.cloudiness = 200;
  milk.tint = {0.8f, 0.8f, 0.8f};
  const RgbImage image = pool(0.2f, milk);
  int least = 765, most = 0;
  for (int y = 100; y < 156; ++y)
    for (int x = 100; x < 156; ++x) {
      least = std::min(least, brightness(image, x, y));
      most = std::max(most, brightness(image, x, y));
    }
  EXPECT_LT(most - least, 40);
}

TEST_F(Surface, HoneyIsYellow) {
  const auto [r, g, b] = pixel(pool(0.2f, {{1.0f, 7.0f, 34.0f}, {0.93f, 0.60f, 0.12f}, 3.0f, 1.49f}), 128, 128);
  EXPECT_GT(r, g);
  EXPECT_GT(g, b + 40);
}

// A red block above the water, in it near its surface, and below a cloudy depth.
TEST_F(Surface, OpaqueMatterAndWaterHideEachOther) {
  Liquid cloudy;
  cloudy.cloudiness = 30;
  const std::vector<Vec3f> at = filled({{0.2f, 0, 0.2f}, {0.8f, 0.3f, 0.8f}}, spacing);
  ParticleBatch batches[2]{water(at), {}};
  batches[0].liquid = cloudy;
  batches[1].look = "spheres";
  batches[1].radius = 0.02f;
  batches[1].base_color = {0.9f, 0.1f, 0.1f};
  const auto block_color = [&](float y, bool wet) {
    const std::vector<Vec3f> block = filled({{0.4f, y, 0.4f}, {0.6f, y + 0.04f, 0.6f}}, 0.02f);
    batches[1].position = block;
    Picture picture;
    picture.particles = wet ? std::span<const ParticleBatch>(batches) : std::span<const ParticleBatch>(batches + 1, 1);
    return pixel(drawn(picture, above()), 128, 128);
  };
  EXPECT_EQ(block_color(0.4f, true), block_color(0.4f, false));
  const auto redness = [&](float y) {
    const auto [r, g, b] = block_color(y, true);
    return r - g;
  };
  const int over = redness(0.4f), near = redness(0.24f), deep = redness(0.02f);
  EXPECT_GT(over, 80);
  EXPECT_LT(near, over - 20);
  EXPECT_GT(near, deep + 20);
  EXPECT_LT(deep, 20);
}

TEST_F(Surface, OpaqueMatterBesideKeepsItsColor) {
  const std::vector<Vec3f> at = filled({{0.1f, 0, 0.1f}, {0.4f, 0.2f, 0.9f}}, spacing);
  const std::vector<Vec3f> block = filled({{0.6f, 0, 0.4f}, {0.8f, 0.2f, 0.6f}}, 0.02f);
  ParticleBatch batches[2]{{}, water(at)};
  batches[0].position = block;
  batches[0].radius = 0.02f;
  Picture picture;
  picture.particles = {batches, 1};
  const RgbImage dry = drawn(picture, above());
  picture.particles = batches;
  const RgbImage wet = drawn(picture, above());
  const auto spot = above().project({0.7f, 0.2f, 0.5f}, 256, 256);
  const int x = static_cast<int>(spot->x), y = static_cast<int>(spot->y);
  EXPECT_EQ(pixel(dry, x, y), pixel(wet, x, y));
  EXPECT_GT(changed_pixels(dry, wet), 2000);
}

// A pane before the water, and one behind it.
TEST_F(Surface, WaterShowsThroughGlass) {
  const std::vector<Vec3f> at = filled({{0.3f, 0, 0.3f}, {0.7f, 0.5f, 0.7f}}, spacing);
  const ParticleBatch batch = water(at);
  const auto through = [&](float z, bool wet) {
    const std::vector<Vec3f> corners{{-1, 0, z}, {2, 0, z}, {2, 2, z}, {-1, 2, z}};
    const std::vector<std::array<std::uint32_t, 3>> sides{{0, 1, 2}, {0, 2, 3}};
    MeshBatch pane;
    pane.vertices = corners, pane.triangles = sides;
    pane.color = {0.9f, 0.1f, 0.1f}, pane.opacity = 0.25f;
    Picture picture;
    picture.meshes = {&pane, 1};
    if (wet) picture.particles = {&batch, 1};
    return pixel(drawn(picture, {{0.5f, 0.5f, 2.2f}, {0.5f, 0.25f, 0.5f}}), 128, 128);
  };
  const auto dry = through(0.9f, false), before = through(0.9f, true), behind = through(0.1f, true);
  EXPECT_LT(before[0], dry[0] - 20) << "the water";
  EXPECT_GT(before[0] - before[2], behind[0] - behind[2] + 15) << "and the red of the pane over it";
}

/// A red post on the floor, 0.1 m wide, in water with waves on it or dry; and the edges of the box.
struct Post : Surface {
  static RgbImage shown(bool wet, bool outline) {
    std::vector<Vec3f> at = filled({{0, 0, 0}, {1, 0.5f, 1}}, spacing);
    std::erase_if(at, [](const Vec3f& p) {
      return p.y > 0.3f + 0.05f * std::sin(20 * p.x) * std::cos(16 * p.z) ||
             (std::abs(p.x - 0.5f) < 0.05f && std::abs(p.z - 0.5f) < 0.05f);
    });
    std::uint64_t n = 0;
    for (Vec3f& p : at)
      for (int axis = 0; axis < 3; ++axis) p[axis] += 0.5f * spacing * static_cast<float>(uniform(3, n++) - 0.5);
    ParticleBatch batch = water(at);
    batch.liquid.absorption = {}, batch.liquid.cloudiness = 0;
    MeshBatch mesh;
    std::vector<Vec3f> corners;
    for (int k = 0; k < 8; ++k) corners.push_back({k & 1 ? 0.55f : 0.45f, k & 2 ? 0.6f : 0.0f, k & 4 ? 0.55f : 0.45f});
    const std::vector<std::array<std::uint32_t, 3>> sides{{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 4, 6},
                                                          {0, 6, 2}, {1, 5, 7}, {1, 7, 3}, {2, 3, 7}, {2, 7, 6}};
    mesh.vertices = corners, mesh.triangles = sides;
    mesh.color = {0.9f, 0.1f, 0.1f};
    Picture picture;
    if (wet) picture.particles = {&batch, 1};
    picture.meshes = {&mesh, 1};
    picture.outline = outline;
    return drawn(picture, {{1.6f, 1.3f, 1.9f}, {0.5f, 0.15f, 0.5f}}, 512, 512);
  }
};

TEST_F(Post, WhatStandsInWaterIsNotTorn) {
  const RgbImage image = shown(true, false);
  const auto is_red = [&](int x, int y) {
    const auto [r, g, b] = pixel(image, x, y);
    return r > g + 20;
  };
  int red = 0, alone = 0;  // pixels that differ from both beside them, or from those above and below
  for (int y = 1; y < 511; ++y)
    for (int x = 1; x < 511; ++x) {
      const bool here = is_red(x, y);
      red += here;
      alone += (is_red(x - 1, y) != here && is_red(x + 1, y) != here) ||
               (is_red(x, y - 1) != here && is_red(x, y + 1) != here);
    }
  EXPECT_GT(red, 4300) << "it is seen down to its foot";
  EXPECT_LT(alone, 0.02 * red);
}

TEST_F(Post, EdgesOfTheBoxStandBehindWaterOrBeforeIt) {
  const RgbImage bare = shown(true, false), image = shown(true, true), dry = shown(false, true);
  const Camera camera{{1.6f, 1.3f, 1.9f}, {0.5f, 0.15f, 0.5f}};
  const auto at = [&](const RgbImage& in, const Vec3f& p) {
    const auto seen = camera.project(p, 512, 512);
    return brightness(in, static_cast<int>(seen->x), static_cast<int>(seen->y));
  };
  EXPECT_LT(at(image, {1, 0.1f, 1}), at(bare, {1, 0.1f, 1}) - 30) << "the nearest edge";
  EXPECT_LT(at(image, {0, 0.8f, 0}), at(bare, {0, 0.8f, 0}) - 30) << "the farthest, over the water";
  // Lines that shine through are bent into loops, and look like cracks.
  const auto darker = [](const RgbImage& with, const RgbImage& without) {
    int count = 0;
    for (int y = 0; y < 512; ++y)
      for (int x = 0; x < 512; ++x) count += brightness(with, x, y) < brightness(without, x, y) - 12;
    return count;
  };
  EXPECT_LT(darker(image, bare), 0.9 * darker(dry, shown(false, false))) << "it hides some, and adds none";
}

// A block that is 0.2 m wide seen from the front: its face covers what a square of that size would,
// up to half a sphere on each side.
TEST_F(Surface, SkinCoversItsMatterAndIsSmooth) {
  const std::vector<Vec3f> at = filled({{-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}}, spacing);
  ParticleBatch batch = water(at);
  batch.look = "skin";
  batch.base_color = {0.9f, 0.1f, 0.1f};
  Picture picture = test::empty_picture();
  picture.particles = {&batch, 1};
  const Camera camera = test::front_camera();
  const RgbImage image = drawn(picture, camera);
  int red = 0, least = 765, most = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const auto [r, g, b] = pixel(image, x, y);
      red += r > 3 * g / 2;
      if (std::abs(x - 128) < 20 && std::abs(y - 128) < 20) {
        least = std::min(least, brightness(image, x, y));
        most = std::max(most, brightness(image, x, y));
      }
    }
  const float slope = camera.pixels_per_slope(256) / 1.8f, side = 0.4f * slope, more = 2 * spacing * slope;
  EXPECT_GT(red, side * side);
  EXPECT_LT(red, (side + more) * (side + more));
  EXPECT_LT(most - least, 40);
}

// Near the eye the filter goes in strides: what it leaves between its columns and rows would show
// as hatching, two pixels to a texel.
TEST_F(Surface, NothingIsHatchedNearTheEye) {
  std::vector<Vec3f> at = test::filled({{-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f}}, 0.03f);
  // A ball and a ridge behind it, off the lattice.
  std::erase_if(
      at, [](const Vec3f& p) { return length2(p) > 0.2f * 0.2f && (p.z > -0.18f || std::abs(p.x + p.y) > 0.15f); });
  std::uint64_t n = 0;
  for (Vec3f& p : at)
    for (int axis = 0; axis < 3; ++axis) p[axis] += 0.02f * static_cast<float>(uniform(5, n++) - 0.5);
  ParticleBatch batch;
  batch.position = at;
  batch.spacing = 0.03f, batch.radius = 0.8f * 0.03f;
  batch.look = "skin";
  Picture picture = test::empty_picture();
  picture.particles = {&batch, 1};
  Camera camera = test::front_camera();
  camera.eye = {0.3f, 0.4f, 0.8f};
  const RgbImage image = drawn(picture, camera, 640, 640);
  // How far each texel is off the mean of those beside it, where that is no edge of something.
  double rough = 0;
  int count = 0;
  for (int y = 4; y < 636; ++y)
    for (int x = 4; x < 636; ++x) {
      const int here = brightness(image, x, y);
      for (const auto& [dx, dy] : {std::pair{2, 0}, {0, 2}}) {
        const int a = brightness(image, x - dx, y - dy), b = brightness(image, x + dx, y + dy);
        if (std::abs(a - b) > 60) continue;
        rough += std::abs(2 * here - a - b) > 24;
        ++count;
      }
    }
  EXPECT_LT(rough / count, 0.025);
}

TEST_F(Surface, SkinTakesColorsOfParticlesAndHidesWhatIsBehind) {
  const std::vector<Vec3f> at = filled({{-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}}, spacing);
  std::vector<std::array<std::uint8_t, 4>> color;
  for (const Vec3f& p : at)
    color.push_back(p.x < 0 ? std::array<std::uint8_t, 4>{220, 20, 20, 255}
                            : std::array<std::uint8_t, 4>{20, 20, 220, 255});
  const std::vector<Vec3f> behind{{0, 0, -0.5f}};
  ParticleBatch batches[2]{water(at), {}};
  batches[0].look = "skin";
  batches[0].color = color;
  batches[1].position = behind;
  batches[1].radius = 0.3f;
  batches[1].base_color = {0.1f, 0.9f, 0.1f};
  Picture picture = test::empty_picture();
  picture.particles = batches;
  const RgbImage image = drawn(picture, test::front_camera());
  const auto left = pixel(image, 110, 128), right = pixel(image, 146, 128);
  EXPECT_GT(left[0], 2 * left[2]);
  EXPECT_GT(right[2], 2 * right[0]);
  EXPECT_LT(left[1], left[0]);
}

TEST_F(Surface, WhatLetsLightThroughShowsWhatIsBehind) {
  const std::vector<Vec3f> at = filled({{-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}}, spacing), behind{{0, 0, -0.5f}};
  Camera camera = test::front_camera();
  camera.orbit(0.2f, 0.13f);  // else spheres of one layer are equally far, and all of them are blended
  for (const std::string_view look : {"spheres", "grains", "skin"}) {
    ParticleBatch batches[2]{water(at), {}};
    batches[0].look = look;
    batches[0].base_color = {0.9f, 0.1f, 0.1f};
    batches[0].opacity = 0.5f;
    batches[1].position = behind;
    batches[1].radius = 0.3f;
    batches[1].base_color = {0.1f, 0.9f, 0.1f};
    Picture picture = test::empty_picture();
    picture.particles = batches;
    const auto mixed = test::mean(drawn(picture, camera), 118, 138);
    batches[0].opacity = 1;
    const auto solid = test::mean(drawn(picture, camera), 118, 138);
    EXPECT_GT(mixed[1], solid[1] + 30) << look;
    EXPECT_GT(mixed[0], 60) << look;
  }
}

}  // namespace
}  // namespace dreampm::gl
