// Conservation: what no surface absorbs must come back as the sky's own light.
#include <gtest/gtest.h>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"
#include "dreampm/render/color.h"
#include "dreampm/render/intersect.h"
#include "shapes.h"

namespace dreampm {
namespace {

TEST(Fresnel, MatchesKnownValuesOfWater) {
  float cos_out = 0;
  EXPECT_NEAR(trace::fresnel(1, 1 / 1.333f, cos_out), std::pow(0.333f / 2.333f, 2), 1e-6f);
  EXPECT_NEAR(cos_out, 1, 1e-6f);
  // at Brewster's angle only one polarisation is reflected, by ((n^2-1)/(n^2+1))^2
  const float n = 1.333f, brewster = std::cos(std::atan(n));
  EXPECT_NEAR(trace::fresnel(brewster, 1 / n, cos_out), 0.5f * std::pow((n * n - 1) / (n * n + 1), 2), 1e-6f);
  // Snell
  EXPECT_NEAR(std::sqrt(1 - cos_out * cos_out) * n, std::sqrt(1 - brewster * brewster), 1e-6f);
  // total reflection from inside begins at asin(1/n) = 48.6 degrees
  EXPECT_LT(trace::fresnel(std::cos(48.4f * trace::degree), n, cos_out), 1);
  EXPECT_EQ(trace::fresnel(std::cos(48.8f * trace::degree), n, cos_out), 1);
  EXPECT_NEAR(trace::pane_reflectance(1), 0.0769f, 1e-4f);
}

TEST(Furnace, WhiteMatteBallIsInvisible) {
  const TriMesh ball = ball_mesh({}, 1, 24);
  for (const float roughness : {1.0f, 0.4f, 0.05f}) {
    const auto scene = before_uniform_sky({&ball, model::Look::opaque(srgb_of({1, 1, 1}), roughness)}, 20);
    const Vec3f mean = mean_of(render(scene, small_picture(32, 32, 16)));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], 1, 0.004f) << "roughness " << roughness;
  }
}

TEST(Furnace, ClearBallIsInvisible) {
  const TriMesh ball = ball_mesh({}, 1, 48);
  const auto scene = before_uniform_sky({&ball, model::Look::dielectric(1.333, {})}, 30);
  const Image image = render(scene, small_picture(48, 48, 16));
  const Vec3f mean = mean_of(image);
  EXPECT_NEAR(mean.x, 1, 0.01f);
  EXPECT_NEAR(mean.z, 1, 0.01f);
}

TEST(Furnace, GrayBallSendsBackItsAlbedo) {
  const std::vector<Vec3f> at{{0, 0, 0}};
  const std::vector<Vec3f> color{{0.25f, 0.5f, 0.75f}};
  const auto scene = before_uniform_sky({RenderSpheres{at, 1, color}, model::Look::opaque({0.9, 0.9, 0.9})}, 12);
  const Vec3f mean = mean_of(render(scene, small_picture(24, 24, 8)));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], color[0][k], 1e-4f);
}

TEST(Furnace, AGrainCoversItsShareAndSendsBackItsAlbedo) {
  const std::vector<Vec3f> at{{0, 0, 0}}, color{{0, 0.5f, 1}};
  const std::vector<float> radius{1};
  for (const float opacity : {1.0f, 0.25f, 0.02f}) {
    const std::vector<float> covers{opacity};
    const auto scene =
        before_uniform_sky({RenderGrains{at, radius, covers, color}, model::Look::opaque({1, 1, 1})}, 12);
    const Vec3f mean = mean_of(render(scene, small_picture(24, 24, 512)));
    // Grains are met by lot: within four standard errors, and exactly where it covers all.
    const float error = std::sqrt(opacity * (1 - opacity) / (24 * 24 * 512));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(mean[k], 1 - opacity + opacity * color[0][k], 4 * error * (1 - color[0][k]) + 1e-4f) << opacity;
  }
}

TEST(Grains, ALayerOfThemDimsByTheProductOfWhatTheyLeave) {
  // Closer to each other than rays start from a surface, on either side of a plate.
  std::vector<Vec3f> at, color;
  for (int i = 0; i < 40; ++i) at.push_back({0, 0, 1 + 1e-6f * static_cast<float>(i)}), at.push_back({0, 0, -1});
  color.assign(at.size(), {1, 1, 1});
  const std::vector<float> radius(at.size(), 0.1f), covers(at.size(), 0.1f);
  const TriMesh plate = box_mesh({-1, -1, -0.2f}, {1, 1, 0});
  RenderScene scene = before_uniform_sky({&plate, model::Look::opaque({1, 1, 1})}, 12);
  scene.objects.push_back({RenderGrains{at, radius, covers, color}, model::Look::opaque({1, 1, 1})});
  const trace::Geometry geometry(scene);
  trace::PassedGrains passed;
  const trace::Hit hit = geometry.cast({0, 0, 4}, {0, 0, -1}, trace::air, 0.5f, 1e9f, &passed);
  EXPECT_NEAR(hit.t, 4, 1e-4f);
  EXPECT_EQ(hit.grain, 0);
  EXPECT_NEAR(passed.left, std::pow(0.9f, 40.0f), 1e-5f);
  // Without a note they are hit.
  EXPECT_GT(geometry.cast({0, 0, 4}, {0, 0, -1}, trace::air, 0.5f).grain, 0);
}

TEST(Furnace, ManyWhiteGrainsAreInvisible) {
  std::vector<Vec3f> at, color;
  std::vector<float> radius, covers;
  for (int i = 0; i < 400; ++i) {
    const auto place = [i](int axis) {
      return 2 * static_cast<float>(uniform(1, static_cast<std::uint64_t>(3 * i + axis))) - 1;
    };
    at.push_back({place(0), place(1), place(2)}), color.push_back({1, 1, 1});
    radius.push_back(0.1f), covers.push_back(i % 2 == 0 ? 0.3f : 1.0f);
  }
  const auto scene = before_uniform_sky({RenderGrains{at, radius, covers, color}, model::Look::opaque({1, 1, 1})}, 20);
  // Paths end after 15 bounces: a little is lost.
  EXPECT_NEAR(mean_of(render(scene, small_picture(24, 24, 16))).y, 1, 0.03f);
}

TEST(Slab, TransmitsByFresnelAndBeerLambert) {
  const Vec3f sigma{3, 1, 0.2f};
  const float r = std::pow(0.333f / 2.333f, 2.0f);
  float last = 1;
  for (const float thick : {0.1f, 0.3f, 0.9f}) {
    const TriMesh slab = box_mesh({-1, -1, -thick / 2}, {1, 1, thick / 2});
    const auto scene = before_uniform_sky({&slab, model::Look::dielectric(1.333, static_cast<Vec3d>(sigma))}, 1);
    const Vec3f mean = mean_of(render(scene, small_picture(16, 16, 32)));
    for (int k = 0; k < 3; ++k) {
      // all orders of reflection inside leave the slab, to one side or the other, where the sky is
      // 1
      const float t = std::exp(-sigma[k] * thick);
      EXPECT_NEAR(mean[k], r + (1 - r) * (1 - r) * t / (1 - r * t), 0.003f) << "thickness " << thick;
    }
    EXPECT_LT(mean.x, last - 0.1f) << "a thicker slab is darker";
    last = mean.x;
  }
}

TEST(Render, AMeshMayBringItsOwnColors) {
  const TriMesh ball = ball_mesh({}, 1, 32);
  std::vector<Vec3f> colors;
  for (const Vec3f& v : ball.vertices) colors.push_back(v.x < 0 ? Vec3f{0.8f, 0.1f, 0.1f} : Vec3f{0.1f, 0.1f, 0.6f});
  const RenderObject object{&ball, model::Look::opaque({0.9, 0.9, 0.9}), colors};
  const Image image = render(before_uniform_sky(object, 4), small_picture(20, 10, 16));
  // Before a sky of radiance 1 a matte ball shows its reflectance.
  for (int y = 0; y < 10; ++y)
    for (const int x : {2, 17}) {
      const Vec3f c = image.linear[static_cast<std::size_t>(y * 20 + x)];
      const Vec3f expected = x < 10 ? Vec3f{0.8f, 0.1f, 0.1f} : Vec3f{0.1f, 0.1f, 0.6f};
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], expected[k], 0.02f) << x << ", " << y;
    }
  const std::span<const Vec3f> few = std::span(colors).first(3);
  EXPECT_THROW(
      render(before_uniform_sky({&ball, model::Look::opaque({0.9, 0.9, 0.9}), few}, 4), small_picture(8, 8, 2)),
      InputError);
}

RenderScene little_pool(const TriMesh& water, const TriMesh& ball) {
  RenderScene s;
  s.basin = {{0, 0, 0}, {1, 0.6f, 0.6f}};
  s.objects = {{&water, model::Look::dielectric()}, {&ball, model::Look::opaque(srgb_of({0.8f, 0.2f, 0.1f}), 0.4f)}};
  return s;
}

TEST(Render, SameBytesForAnyNumberOfThreads) {
  const TriMesh water = box_mesh({0, 0, 0}, {1, 0.25f, 0.6f}), ball = ball_mesh({0.5f, 0.4f, 0.3f}, 0.1f, 16);
  const RenderScene scene = little_pool(water, ball);
  RenderSettings settings = small_picture(48, 27, 4);
  settings.samples = 8;
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return render(scene, settings).linear;
  };
  const auto one = with(1), two = with(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i], two[i]) << "pixel " << i;
  settings.seed = 2;
  EXPECT_NE(with(2), one);
}

TEST(Render, DeeperWaterReadsBluer) {
  const TriMesh ball = ball_mesh({0.5f, 0.5f, 0.3f}, 0.02f, 8);
  float last = 0;
  for (const float depth : {0.02f, 0.1f, 0.3f}) {
    const TriMesh water = box_mesh({0, 0, 0}, {1, depth, 0.6f});
    RenderScene scene = little_pool(water, ball);
    scene.camera.fit_basin = false;
    scene.camera.from = {0.5, 2, 0.35}, scene.camera.to = {0.5, 0, 0.3}, scene.camera.fov = 10;
    const Vec3f mean = mean_of(render(scene, small_picture(16, 16, 4)));
    EXPECT_GT(mean.z / mean.x, last * 1.1f) << "depth " << depth;
    last = mean.z / mean.x;
  }
}

TEST(Render, NamesWhatIsOutOfRange) {
  const TriMesh ball = ball_mesh({}, 1, 4);
  const auto fails = [&](auto change, const char* word) {
    RenderScene scene = before_uniform_sky({&ball, model::Look::opaque({0.9, 0.9, 0.9})}, 30);
    RenderSettings settings = small_picture(8, 8, 2);
    TriMesh broken = ball;
    change(scene, settings, broken);
    try {
      render(scene, settings);
      FAIL() << "accepted: " << word;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
  };
  fails([](RenderScene&, RenderSettings& s, TriMesh&) { s.width = 0; }, "width");
  fails([](RenderScene&, RenderSettings& s, TriMesh&) { s.noise = std::nanf(""); }, "noise");
  fails([](RenderScene& s, RenderSettings&, TriMesh&) { s.basin.max.y = -2; }, "basin");
  fails([](RenderScene& s, RenderSettings&, TriMesh&) { s.objects[0].look = model::Look::dielectric(0.5, {}); }, "ior");
  fails([](RenderScene& s, RenderSettings&, TriMesh&) { s.camera.to = s.camera.from; }, "from");
  fails(
      [](RenderScene& s, RenderSettings&, TriMesh& m) {
        m.triangles[3][1] = 9999;
        s.objects[0].form = &m;
      },
      "9999");
}

}  // namespace
}  // namespace dreampm
