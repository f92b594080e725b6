// Matter that scatters: against a furnace, and Chandrasekhar's exact solutions of a deep layer.
#include <gtest/gtest.h>

#include <vector>

#include "dreampm/io/exr.h"
#include "dreampm/render/color.h"
#include "dreampm/render/phase.h"
#include "shapes.h"

namespace dreampm {
namespace {

using trace::pi;

model::Look cloud(double ior, double scattering, double absorption = 0, double anisotropy = 0) {
  const auto gray = [](double x) { return Vec3d{x, x, x}; };
  return model::Look::dielectric(ior, gray(absorption), gray(scattering), anisotropy);
}

TEST(Phase, SamplesHaveTheirMeanCosineAndTheDensityIsWhole) {
  for (const float g : {-0.6f, 0.0f, 0.3f, 0.9f}) {
    constexpr int n = 20000;
    double mean = 0, whole = 0;
    for (int i = 0; i < n; ++i) {
      const float a = (static_cast<float>(i) + 0.5f) / n;
      const Vec3f d = trace::sample_phase({0, 1, 0}, g, a, 0.3f);
      EXPECT_NEAR(length(d), 1, 1e-4f);
      mean += static_cast<double>(d.y) / n;
      whole += static_cast<double>(trace::phase(2 * a - 1, g)) * 4 * std::numbers::pi / n;
    }
    EXPECT_NEAR(mean, g, 2e-3);
    EXPECT_NEAR(whole, 1, 2e-3);
  }
}

// The error of 4,000 paths whose values scatter by 0.2 is 0.003.
TEST(Furnace, AWhiteCloudIsInvisible) {
  const TriMesh ball = ball_mesh({}, 1, 24);
  for (const double ior : {1.0, 1.333})
    for (const double scattering : {0.5, 6.0})
      for (const double g : {0.0, 0.7}) {
        const auto scene = before_uniform_sky({&ball, cloud(ior, scattering, 0, g)}, 20);
        const Vec3f mean = mean_of(render(scene, small_picture(16, 16, 16)));
        EXPECT_NEAR(mean.y, 1, 0.01f) << "ior " << ior << ", " << scattering << "/m, anisotropy " << g;
      }
}

TEST(Furnace, ADenseWhiteCloudIsInvisible) {
  // Paths leap where surfaces are far.
  const TriMesh ball = ball_mesh({}, 1, 24);
  const auto scene = before_uniform_sky({&ball, cloud(1.3, 400)}, 20);
  EXPECT_NEAR(mean_of(render(scene, small_picture(12, 12, 8))).y, 1, 0.005f);
}

/// Paths that leap ask how far the edges of a basin of glass are, too: a dense pool within one.
TEST(Cloud, APoolInABasinOfGlassIsDrawn) {
  const TriMesh pool = box_mesh({0.1f, 0, 0.1f}, {0.9f, 0.5f, 0.9f});
  RenderScene scene;
  scene.basin = {{0, 0, 0}, {1, 1, 1}};
  scene.objects.push_back({&pool, cloud(1.3, 2000)});
  const Image image = render(scene, small_picture(48, 32, 8));
  for (const Vec3f& c : image.linear) EXPECT_TRUE(is_finite(c));
  EXPECT_GT(mean_of(image).y, 0.05f);
}

TEST(Furnace, CloudsOfColorLoseLightByChannel) {
  const TriMesh ball = ball_mesh({}, 1, 24);
  const auto scene = before_uniform_sky({&ball, model::Look::dielectric(1.333, {0.5, 0, 2}, {1, 4, 8})}, 12);
  // Channels share paths, so that one's weights scatter by about 1: an error of 0.005 of 37,000
  // paths.
  const Vec3f mean = mean_of(render(scene, small_picture(24, 24, 64)));
  EXPECT_NEAR(mean.y, 1, 0.015f) << "this one absorbs nothing";
  EXPECT_LT(mean.x, 0.9f);
  EXPECT_LT(mean.z, 0.9f);
}

/// Chandrasekhar's H of isotropic scattering (1960, "Radiative Transfer", V.33), by iteration.
class HFunction {
 public:
  explicit HFunction(double albedo) : albedo_(albedo), h_(n, 1.0) {
    for (int round = 0; round < 400; ++round) {
      std::vector<double> next(n);
      for (int i = 0; i < n; ++i) next[static_cast<std::size_t>(i)] = at(mu(i));
      h_ = next;
    }
  }
  /// 1/H(mu) = sqrt(1 - albedo) + albedo/2 int mu' H(mu')/(mu + mu') dmu'
  double at(double m) const {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += mu(i) * h_[static_cast<std::size_t>(i)] / (m + mu(i)) / n;
    return 1 / (std::sqrt(1 - albedo_) + 0.5 * albedo_ * sum);
  }

 private:
  static constexpr int n = 200;
  static double mu(int i) { return (i + 0.5) / n; }
  double albedo_;
  std::vector<double> h_;
};

/// A deep layer, seen from above.
RenderScene deep_layer(const TriMesh& layer, const model::Look& look) {
  RenderScene scene = before_uniform_sky({&layer, look}, 2);
  scene.camera.from = {0.02, 4, 0.01}, scene.camera.to = {0, 0, 0};
  return scene;
}

TEST(Cloud, ADeepLayerReflectsAsChandrasekharSays) {
  const TriMesh layer = box_mesh({-40, -40, -40}, {40, 0, 40});
  for (const double albedo : {0.5, 0.9, 0.999}) {
    const HFunction h(albedo);
    RenderScene scene = deep_layer(layer, cloud(1, 2 * albedo, 2 * (1 - albedo)));
    // Under an even sky: 1 - H(mu) sqrt(1 - albedo).
    const double even = 1 - h.at(1) * std::sqrt(1 - albedo);
    // Paths' values scatter by 0.4 at most: an error of 0.0014 of 74,000.
    EXPECT_NEAR(mean_of(render(scene, small_picture(24, 24, 128))).y, even, 0.005) << albedo;
    // Under the sun: albedo/(4 pi) mu0/(mu + mu0) H(mu) H(mu0) times its irradiance.
    scene.light.sun.strength = 10, scene.light.sun.elevation = 50, scene.light.sun.angle = 0.2;
    const double mu0 = std::sin(50 * std::numbers::pi / 180);
    const double sunny = even + 10 * albedo / (4 * std::numbers::pi) * mu0 / (1 + mu0) * h.at(1) * h.at(mu0);
    const double sun_color = 0.88;  // of green
    EXPECT_NEAR(mean_of(render(scene, small_picture(24, 24, 64))).y, even + sun_color * (sunny - even), 0.015 * sunny)
        << albedo;
  }
}

/// An environment that is black but for a disc of radiance 1 about a direction.
void write_disc(const std::string& file, const Vec3f& towards, float cos_radius) {
  ExrPicture picture;
  picture.width = picture.full_width = 720, picture.height = picture.full_height = 360;
  for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, false, {}});
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 720; ++x) {
      const float theta = pi * (static_cast<float>(y) + 0.5f) / 360,
                  phi = 2 * pi * ((static_cast<float>(x) + 0.5f) / 720 - 0.5f);
      const Vec3f d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
      for (ExrChannel& c : picture.channels) c.values.push_back(dot(d, towards) > cos_radius ? 1.0f : 0.0f);
    }
  write_exr(file, picture);
}

TEST(Cloud, TheSunBendsIntoItAsLightOfAnEnvironmentThatPathsFind) {
  // Paths meet the environment by chance, through the true face; the sun is aimed at through it.
  const TriMesh layer = box_mesh({-40, -40, -40}, {40, 0, 40});
  RenderScene scene = deep_layer(layer, cloud(1.333, 1.8, 0.2));
  const std::string file = ::testing::TempDir() + "disc.exr";
  scene.light.sun.elevation = 45, scene.light.sun.azimuth = 30, scene.light.sun.angle = 20;
  const float up = std::sqrt(0.5f);
  write_disc(file, {up * std::cos(pi / 6), up, up * std::sin(pi / 6)}, std::cos(20 * trace::degree));
  RenderScene of_disc = scene;
  of_disc.light.environment = file;
  const float found = mean_of(render(of_disc, small_picture(24, 24, 128))).y;
  // The sun of the same disc, alone, before a black environment but for a spot below.
  const std::string dark = ::testing::TempDir() + "dark.exr";
  write_disc(dark, {0, -1, 0}, std::cos(0.5f * trace::degree));
  scene.light.environment = dark;
  scene.light.sun.strength = 2 * std::numbers::pi * (1 - std::cos(20 * std::numbers::pi / 180)) / 0.88;
  const float aimed = mean_of(render(scene, small_picture(24, 24, 32))).y;
  EXPECT_NEAR(aimed, found, 0.04f * found);
  EXPECT_GT(found, 0.02f);
}

}  // namespace
}  // namespace dreampm
