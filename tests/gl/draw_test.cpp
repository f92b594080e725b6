#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "canvas.h"
#include "thrown.h"

namespace dreampm::gl {
namespace {
using dreampm::test::message_of;
using dreampm::test::refusal;
using test::brightness;
using test::changed_pixels;
using test::empty_picture;
using test::front_camera;
using test::pixel;
using testing::AllOf;
using testing::HasSubstr;

struct Draw : test::Drawing {};

ParticleBatch red_balls(std::span<const Vec3f> at, float radius, std::string_view look) {
  ParticleBatch b;
  b.position = at;
  b.radius = radius;
  b.look = look;
  b.base_color = {0.9f, 0.1f, 0.1f};
  return b;
}

// The outline of a sphere in a perspective view is a circle of radius f r / sqrt(d^2 - r^2) pixels
// where its center is on the axis.
TEST_F(Draw, ASphereCoversItsOutline) {
  const Camera camera = front_camera();
  const std::vector<Vec3f> at{{0, 0, 0}};
  Picture picture = empty_picture();
  const ParticleBatch batch = red_balls(at, 0.25f, "spheres");
  picture.particles = {&batch, 1};
  const RgbImage image = drawn(picture, camera);
  const double edge = camera.pixels_per_slope(256) * 0.25 / std::sqrt(4 - 0.25 * 0.25);
  int red = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const auto [cr, cg, cb] = pixel(image, x, y);
      red += cr > 3 * cg / 2;
    }
  EXPECT_NEAR(red, std::numbers::pi * edge * edge, 0.02 * std::numbers::pi * edge * edge);
  const auto [cr, cg, cb] = pixel(image, 128, 128);
  EXPECT_GT(cr, 120);
  EXPECT_LT(cg, cr / 2);
  EXPECT_LT(cb, cr / 2);
}

TEST_F(Draw, TheNearerSphereHidesTheFarther) {
  const std::vector<Vec3f> near{{0, 0, 0.3f}}, far{{0, 0, -0.3f}};
  for (const std::string_view look : {"spheres", "grains", "points"}) {
    ParticleBatch batches[2]{red_balls(near, 0.1f, look), red_balls(far, 0.1f, look)};
    batches[1].base_color = {0.1f, 0.1f, 0.9f};
    Picture picture = empty_picture();
    for (const bool swapped : {false, true}) {
      if (swapped) std::swap(batches[0], batches[1]);
      picture.particles = batches;
      const RgbImage image = drawn(picture, front_camera());
      const auto [r, g, b] = pixel(image, 128, 128);
      EXPECT_GT(r, b) << look << swapped;
    }
  }
}

TEST_F(Draw, AMeshStandsWhereItsPoseSaysAndHidesParticles) {
  const std::vector<Vec3f> at{{0, 0, -0.2f}};
  const ParticleBatch batch = red_balls(at, 0.1f, "spheres");
  const std::vector<Vec3f> corners{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  MeshBatch mesh;
  mesh.vertices = corners;
  mesh.triangles = triangles;
  mesh.color = {0.1f, 0.8f, 0.1f};
  Picture picture = empty_picture();
  picture.particles = {&batch, 1};
  picture.meshes = {&mesh, 1};
  EXPECT_GT(pixel(drawn(picture, front_camera()), 128, 128)[1], 100);
  mesh.pose.position = {0, 0, -0.5};
  EXPECT_GT(pixel(drawn(picture, front_camera()), 128, 128)[0], 100);
  mesh.pose.position = {0, 0, 0.5};
  mesh.opacity = 0.5f;
  const auto [r, g, b] = pixel(drawn(picture, front_camera()), 128, 128);
  EXPECT_GT(r, 60);
  EXPECT_GT(g, 60);
}

TEST_F(Draw, MatterShadesTheFloor) {
  Picture picture;
  picture.outline = false;
  const Camera camera{{0.5f, 2.5f, 0.8f}, {0.5f, 0, 0.5f}};
  const RgbImage bare = drawn(picture, camera);
  const std::vector<Vec3f> at = test::filled({{0.3f, 0.2f, 0.3f}, {0.6f, 0.4f, 0.6f}}, 0.03f);
  const ParticleBatch batch = red_balls(at, 0.02f, "spheres");
  picture.particles = {&batch, 1};
  const RgbImage shaded = drawn(picture, camera);
  // The ray from the light through the middle of the block meets the floor there.
  const Vec3f middle{0.45f, 0.3f, 0.45f}, d = normalized(picture.lights[0].position - Vec3f{0.5f, 0.5f, 0.5f});
  const Vec3f foot = middle - d * (middle.y / d.y);
  const auto spot = camera.project(foot, 256, 256), open = camera.project({0.95f, 0, 0.95f}, 256, 256);
  ASSERT_TRUE(spot && open);
  const auto at_pixel = [](const RgbImage& image, const Projected& p) {
    return brightness(image, static_cast<int>(p.x), static_cast<int>(p.y));
  };
  // Below the block itself red hides the floor: look where the shadow leaves it.
  const auto edge = camera.project(foot + Vec3f{-0.12f, 0, -0.12f}, 256, 256);
  ASSERT_TRUE(edge);
  EXPECT_LT(at_pixel(shaded, *edge), 0.85 * at_pixel(bare, *edge));
  EXPECT_NEAR(at_pixel(shaded, *open), at_pixel(bare, *open), 6);
}

TEST_F(Draw, ValuesTakeColorsFromTheScale) {
  const std::vector<Vec3f> at{{-0.3f, 0, 0}, {0.3f, 0, 0}};
  const std::vector<float> value{10, 20};
  ParticleBatch batch = red_balls(at, 0.1f, "spheres");
  batch.value = value;
  batch.value_min = 10;
  batch.value_max = 20;
  Picture picture = empty_picture();
  picture.particles = {&batch, 1};
  const Camera camera = front_camera();
  const RgbImage image = drawn(picture, camera);
  const auto left = camera.project(at[0], 256, 256), right = camera.project(at[1], 256, 256);
  const auto low = pixel(image, static_cast<int>(left->x), static_cast<int>(left->y));
  const auto high = pixel(image, static_cast<int>(right->x), static_cast<int>(right->y));
  EXPECT_GT(low[2], low[1]);    // violet
  EXPECT_GT(high[0], high[2]);  // yellow
  EXPECT_GT(high[1], 2 * low[1]);
}

TEST_F(Draw, ColorsOfParticlesGoFirst) {
  const std::vector<Vec3f> at{{0, 0, 0}};
  const std::vector<std::array<std::uint8_t, 4>> color{{20, 230, 20, 255}};
  ParticleBatch batch = red_balls(at, 0.2f, "spheres");
  batch.color = color;
  Picture picture = empty_picture();
  picture.particles = {&batch, 1};
  const auto [r, g, b] = pixel(drawn(picture, front_camera()), 128, 128);
  EXPECT_GT(g, 2 * r);
}

/// A ball of foam smaller than a pixel is a share of it: of twice the radius it changes four times
/// as much.
TEST_F(Draw, FoamSmallerThanAPixelCoversItsShare) {
  const std::vector<Vec3f> at{{0.0013f, 0.0011f, 0}};
  const std::vector<std::array<std::uint8_t, 4>> white{{255, 255, 255, 200}};
  Picture picture = empty_picture();
  picture.theme = dark_theme();
  const RgbImage before = drawn(picture, front_camera());
  const auto change = [&](float radius) {
    const std::vector<float> radii{radius};
    ParticleBatch batch = red_balls(at, 1, "foam");
    batch.value = radii, batch.color = white;
    picture.particles = {&batch, 1};
    const RgbImage after = drawn(picture, front_camera());
    // In linear light, about: shaders encode by the root.
    double sum = 0;
    for (std::size_t i = 0; i < after.pixels.size(); ++i)
      sum += std::pow(after.pixels[i] / 255.0, 2) - std::pow(before.pixels[i] / 255.0, 2);
    return sum;
  };
  const double pixel = 2 * std::tan(0.5 * static_cast<double>(front_camera().view_angle)) *
                       static_cast<double>(length(front_camera().eye)) / 256;
  const double small = change(static_cast<float>(0.25 * pixel)), large = change(static_cast<float>(0.5 * pixel));
  EXPECT_GT(small, 0.0);
  // Blending is not in linear light, which makes faint ones fainter than their share.
  EXPECT_GT(large, 2.5 * small);
  EXPECT_LT(large, 16 * small);
}

TEST_F(Draw, WhatIsBehindTheEyeOrNotANumberIsLeftOut) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<Vec3f> at{{0, 0, 4}, {nan, 0, 0}, {0, inf, 0}, {0, 0, -inf}, {0, 0, 2}, {1e30f, 1e30f, -1e30f}};
  for (const std::string_view look : renderer().look_names()) {
    Picture picture = empty_picture();
    const RgbImage before = drawn(picture, front_camera());
    const ParticleBatch batch = red_balls(at, 0.05f, look);
    picture.particles = {&batch, 1};
    EXPECT_EQ(changed_pixels(before, drawn(picture, front_camera())), 0) << look;
  }
}

TEST_F(Draw, EverySizeFromOnePixel) {
  const std::vector<Vec3f> at = test::filled({{0.2f, 0, 0.2f}, {0.8f, 0.3f, 0.8f}}, 0.1f);
  for (const std::string_view look : renderer().look_names())
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 40}, {3, 2}, {97, 61}}) {
      Picture picture;
      const ParticleBatch batch = red_balls(at, 0.06f, look);
      picture.particles = {&batch, 1};
      picture.ring = BrushRing{};
      const RgbImage image = drawn(picture, Camera{}, w, h);
      EXPECT_EQ(image.width, w);
      EXPECT_GT(brightness(image, 0, 0), 0) << look << ' ' << w << ' ' << h;
    }
}

TEST_F(Draw, NoParticlesAtAll) {
  Picture picture;
  const RgbImage nothing = drawn(picture, Camera{});
  for (const std::string_view look : renderer().look_names()) {
    const ParticleBatch batch = red_balls({}, 0.01f, look);
    picture.particles = {&batch, 1};
    EXPECT_EQ(drawn(picture, Camera{}).pixels, nothing.pixels);
  }
}

TEST_F(Draw, TheSameFrameTwiceHasTheSamePixels) {
  const std::vector<Vec3f> at = test::filled({{0.2f, 0, 0.2f}, {0.8f, 0.3f, 0.8f}}, 0.05f);
  for (const std::string_view look : renderer().look_names()) {
    Picture picture;
    const ParticleBatch batch = red_balls(at, 0.04f, look);
    picture.particles = {&batch, 1};
    EXPECT_EQ(drawn(picture, Camera{}).pixels, drawn(picture, Camera{}).pixels) << look;
  }
}

TEST_F(Draw, LinesAndRingAppearWhereTheyAre) {
  Picture picture = empty_picture();
  const RgbImage before = drawn(picture, front_camera());
  const std::vector<LineSegment> segments{{{-0.5f, 0.3f, 0}, {0.5f, 0.3f, 0}, {1, 0, 0}, 1}};
  picture.segments = segments;
  picture.ring = BrushRing{{0, -0.3f, 0}, {0, 0, 1}, 0.1f, {0, 0, 1}};
  const Camera camera = front_camera();
  const RgbImage image = drawn(picture, camera);
  const auto on_line = camera.project({0.2f, 0.3f, 0}, 256, 256), on_ring = camera.project({0.1f, -0.3f, 0}, 256, 256),
             inside = camera.project({0, -0.3f, 0}, 256, 256);
  EXPECT_GT(pixel(image, static_cast<int>(on_line->x), static_cast<int>(on_line->y))[0], 200);
  EXPECT_LT(pixel(image, static_cast<int>(on_line->x), static_cast<int>(on_line->y))[1], 120);
  EXPECT_LT(pixel(image, static_cast<int>(on_ring->x), static_cast<int>(on_ring->y))[0], 120);
  const int x = static_cast<int>(inside->x), y = static_cast<int>(inside->y);
  EXPECT_EQ(pixel(image, x, y), pixel(before, x, y));
}

TEST_F(Draw, BadPicturesAreRefused) {
  const std::vector<Vec3f> at{{0, 0, 0}, {0, 0.1f, 0}};
  const std::vector<float> one{1};
  const Framebuffer framebuffer(8, 8);
  Picture picture = empty_picture();
  ParticleBatch batch = red_balls(at, 0.1f, "glitter");
  picture.particles = {&batch, 1};
  const auto draw = [&] { renderer().draw(picture, front_camera(), framebuffer); };
  EXPECT_THAT(refusal(draw), AllOf(HasSubstr("glitter"), HasSubstr("points, spheres, grains, skin, water")));
  batch.look = "spheres";
  batch.value = one;
  EXPECT_THAT(refusal(draw), AllOf(HasSubstr("2 particles"), HasSubstr("1 values")));
  batch.value = {};
  batch.radius = 0;
  EXPECT_THAT(refusal(draw), HasSubstr("radius 0"));
  batch.radius = 0.1f;
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 7}};
  MeshBatch mesh;
  mesh.vertices = at;
  mesh.triangles = triangles;
  picture.meshes = {&mesh, 1};
  EXPECT_THAT(refusal(draw), AllOf(HasSubstr("vertex 7"), HasSubstr("only 2")));
}

TEST_F(Draw, FramebuffersHaveTheirLimits) {
  EXPECT_THAT(refusal([] { Framebuffer(0, 10); }), HasSubstr("from 1 to"));
  EXPECT_THAT(refusal([] { Framebuffer(8193, 10); }), AllOf(HasSubstr("8193 x 10"), HasSubstr("from 1 to")));
  Framebuffer kept(5, 4);
  EXPECT_THROW(kept.resize(-1, 4), InputError);
  EXPECT_EQ(kept.width(), 5);
}

}  // namespace
}  // namespace dreampm::gl
