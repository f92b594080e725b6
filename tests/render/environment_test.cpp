// Light from all around: pictures of it, and how paths aim at it.
#include "dreampm/render/environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "dreampm/base/error.h"
#include "dreampm/io/exr.h"
#include "dreampm/render/color.h"
#include "dreampm/render/lamps.h"
#include "dreampm/render/looks.h"
#include "dreampm/render/sky.h"
#include "shapes.h"
#include "thrown.h"

namespace dreampm {
namespace {

using namespace trace;

template <class Of>
Environment picture_of(int height, Of&& of, float turn = 0) {
  std::vector<Vec3f> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const float theta = pi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height),
                  phi = pi * ((static_cast<float>(x) + 0.5f) / static_cast<float>(height) - 1);
      pixels.push_back(of(Vec3f{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}));
    }
  return {2 * height, height, std::move(pixels), turn};
}

Vec3f ramp(const Vec3f& d) { return Vec3f{1, 1, 1} * (1 + 0.6f * d.y + 0.3f * d.x); }
Vec3f spot(const Vec3f& d) {
  return dot(d, normalized(Vec3f{0.3f, 0.8f, -0.5f})) > 0.99f ? Vec3f{80, 60, 40} : Vec3f{0.1f, 0.1f, 0.2f};
}

TEST(Environment, ItsIrradianceIsItsIntegral) {
  // Of 1 + a.d on a plane along n: pi (1 + 2/3 a.n).
  const Environment e = picture_of(128, ramp);
  for (const Vec3f& n : {Vec3f{0, 1, 0}, Vec3f{1, 0, 0}, normalized(Vec3f{-1, 0.4f, 2})})
    EXPECT_NEAR(e.irradiance(n).y, pi * (1 + 2.0f / 3 * (0.6f * n.y + 0.3f * n.x)), 2e-3f);
}

TEST(Environment, DrawnLightHasTheIrradianceAndTheDensityIsWhole) {
  const Vec3f n = normalized(Vec3f{0.2f, 1, 0.3f});
  for (const auto& of : {&ramp, &spot}) {
    const Environment e = picture_of(64, *of);
    constexpr int across = 200;
    Vec3d sum;
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < across; ++j) {
        const auto drawn = e.draw((static_cast<float>(i) + 0.5f) / across, (static_cast<float>(j) + 0.5f) / across);
        ASSERT_GT(drawn.density, 0);
        EXPECT_NEAR(drawn.density, e.density(drawn.direction), 1e-4f * drawn.density);
        const float c = dot(n, drawn.direction);
        if (c > 0) sum += static_cast<Vec3d>(drawn.radiance * (c / drawn.density)) / double(across * across);
      }
    EXPECT_NEAR(sum.y, e.irradiance(n).y, 0.01 * e.irradiance(n).y);
    double whole = 0;
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < 2 * across; ++j) {
        const float y = 1 - (static_cast<float>(i) + 0.5f) * 2 / across, r = std::sqrt(1 - y * y),
                    phi = pi * (static_cast<float>(j) + 0.5f) / across;
        whole += static_cast<double>(e.density({r * std::cos(phi), y, r * std::sin(phi)})) * 4 * std::numbers::pi /
                 (2.0 * across * across);
      }
    EXPECT_NEAR(whole, 1, 0.02);
  }
}

TEST(Environment, ItsBrightPartsAreWhatIsAboveTheLimit) {
  const Environment e = picture_of(128, spot);
  const auto bright = e.bright_parts(3);
  ASSERT_TRUE(bright.has_value());
  const Vec3f at = normalized(Vec3f{0.3f, 0.8f, -0.5f}), all = e.radiance(at), above = bright->radiance(at);
  EXPECT_GT(luminance(above), 0);
  EXPECT_NEAR(above.x / all.x, above.z / all.z, 1e-4f);
  EXPECT_LT(luminance(all - above), 0.1f * luminance(all));
  EXPECT_EQ(bright->radiance({0, -1, 0}).x, 0);
  EXPECT_FALSE(picture_of(64, ramp).bright_parts(3).has_value());
}

TEST(Environment, TurnsByTheRightHandAboutTheVertical) {
  // A quarter turn brings what was towards +x towards -z.
  const auto ahead = [](const Vec3f& d) { return d.x > 0.9f ? Vec3f{5, 5, 5} : Vec3f{}; };
  const Environment straight = picture_of(64, ahead), turned = picture_of(64, ahead, pi / 2);
  EXPECT_NEAR(straight.radiance({1, 0, 0}).x, 5, 1e-4f);
  EXPECT_NEAR(turned.radiance({0, 0, -1}).x, 5, 1e-4f);
  EXPECT_NEAR(turned.radiance({1, 0, 0}).x, 0, 1e-4f);
  EXPECT_LT(turned.draw(0.5f, 0.5f).direction.z, -0.8f);
}

std::string written(const std::string& name, int width, int height, const std::function<float(int, int)>& value) {
  ExrPicture picture;
  picture.width = picture.full_width = width, picture.height = picture.full_height = height;
  for (const char* channel : {"R", "G", "B"}) {
    picture.channels.push_back({channel, false, {}});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) picture.channels.back().values.push_back(value(x, y));
  }
  const std::string file = ::testing::TempDir() + name;
  write_exr(file, picture);
  return file;
}

TEST(Environment, ASmallBrightLightLightsAPlateAsItsIrradianceSays) {
  // Aimed at and met by bounces, neither twice: matte and coated plates, by multiple importance
  // sampling.
  const std::string file =
      written("spot.exr", 256, 128, [](int x, int y) { return x > 60 && x < 66 && y > 25 && y < 30 ? 400.0f : 0.3f; });
  const TriMesh plate = box_mesh({-1, -0.1f, -1}, {1, 0, 1});
  for (const double roughness : {1.0, 0.5}) {
    RenderScene scene = before_uniform_sky({&plate, model::Look::opaque(srgb_of({0.5f, 0.5f, 0.5f}), roughness)}, 6);
    scene.light.environment = file;
    scene.camera.from = {0.2, 4, 0.1};
    const Vec3f mean = mean_of(render(scene, small_picture(16, 16, 64)));
    const Sky sky(scene.light, true);
    const Environment& e = *sky.aimed_at();
    if (roughness == 1.0) {
      EXPECT_NEAR(mean.y, e.irradiance({0, 1, 0}).y * 0.5f / pi, 0.02f * mean.y);
      continue;
    }
    // The same by a fine sum over the sphere.
    const auto bsdf = traced(scene.objects[0].look)->bsdf(1);
    const Vec3f view = normalized(Vec3f{0.2f, 0.1f, 4});
    double sum = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const float y = (static_cast<float>(i) + 0.5f) / n, r = std::sqrt(1 - y * y),
                    phi = 2 * pi * (static_cast<float>(j) + 0.5f) / n;
        const Vec3f d{r * std::cos(phi), y, r * std::sin(phi)};
        sum += static_cast<double>(e.radiance(d).y * bsdf->eval(view, {d.x, d.z, d.y}, {0.5f, 0.5f, 0.5f}).y) * 2 *
               std::numbers::pi / n / n;
      }
    EXPECT_NEAR(mean.y, sum, 0.03 * sum);
  }
}

TEST(Environment, CausticsByPhotonsBringTheLightThatChanceBrings) {
  // A slab of glass over a matte plate: the light of a spot through it.
  const std::string file =
      written("spot2.exr", 128, 64, [](int x, int y) { return x > 30 && x < 40 && y > 5 && y < 15 ? 60.0f : 0.3f; });
  const TriMesh plate = box_mesh({-3, -0.2f, -3}, {3, -0.1f, 3}), slab = box_mesh({-1, 0, -1}, {1, 0.2f, 1});
  RenderScene scene = before_uniform_sky({&plate, model::Look::opaque(srgb_of({0.5f, 0.5f, 0.5f}))}, 6);
  model::Look glass;
  glass.type = model::LookType::dielectric, glass.ior = 1.5, glass.absorption = {0, 0, 0};
  scene.objects.push_back({&slab, glass});
  scene.light.environment = file;
  scene.camera.from = {0.2, 4, 0.1};
  RenderSettings settings = small_picture(16, 16, 1024);
  settings.caustics = false;
  const Vec3f by_chance = mean_of(render(scene, settings));
  settings.caustics = true, settings.samples = settings.min_samples = 64;
  const Vec3f by_photons = mean_of(render(scene, settings));
  // The standard error of chance is a hundredth.
  EXPECT_NEAR(by_photons.y, by_chance.y, 0.03f * by_chance.y);
}

TEST(Environment, ABadFileIsNamedWithWhatIsWrong) {
  const auto of = [](const std::string& file) {
    model::Light light;
    light.environment = file;
    return test::refusal([&] { Sky(light, false); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(of("nowhere.exr"), HasSubstr("nowhere.exr"));
  EXPECT_THAT(of(written("square.exr", 64, 64, [](int, int) { return 1.0f; })),
              AllOf(HasSubstr("square.exr"), HasSubstr("64 x 64"), HasSubstr("twice as wide as high")));
  EXPECT_THAT(of(written("nan.exr", 64, 32, [](int x, int y) { return x == 5 && y == 7 ? std::nanf("") : 1.0f; })),
              AllOf(HasSubstr("nan.exr"), HasSubstr("pixel (5, 7)")));
  EXPECT_THAT(of(written("black.exr", 64, 32, [](int, int) { return 0.0f; })), HasSubstr("black all over"));
  const std::string text = ::testing::TempDir() + "text.exr";
  std::ofstream(text) << "not a picture";
  EXPECT_THAT(of(text), HasSubstr("text.exr"));
}

TEST(Lamps, LightAsBallsDo) {
  // Irradiance square to the way to a ball of radiance L: pi L r^2/d^2.
  const Lamps lamps({{{0, 2, 0}, 0.3f, {10, 10, 10}}, {{3, 1, 0}, 0.1f, {200, 100, 50}}});
  Vec3d sum;
  constexpr int n = 20000;
  const Vec3f up{0, 1, 0};
  for (std::uint32_t i = 0; i < n; ++i) {
    Sampler random(5, i);
    const LightSample s = lamps.draw({0, 0, 0}, random);
    ASSERT_NE(lamps.met({0, 0, 0}, s.direction, s.distance * 1.01f), nullptr);
    EXPECT_EQ(lamps.met({0, 0, 0}, s.direction, s.distance * 0.99f), nullptr);
    sum += static_cast<Vec3d>(s.irradiance * dot(up, s.direction)) / double(n);
  }
  const double near = 10 * 0.09 / 4, far = 100 * 0.01 / 10 / std::sqrt(10.0);
  EXPECT_NEAR(sum.y, std::numbers::pi * (near + far), 0.01 * std::numbers::pi * (near + far));
}

}  // namespace
}  // namespace dreampm
