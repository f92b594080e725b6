// Metal, plastic and wood: what they send back, by samples and by formula.
#include <gtest/gtest.h>

#include <howto/plaster.h>
#include <array>
#include <string>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/render/color.h"
#include "dreampm/render/glossy.h"
#include "dreampm/render/looks.h"
#include "dreampm/render/sky.h"
#include "dreampm/render/wood.h"
#include "shapes.h"

namespace dreampm {
namespace {

using namespace trace;

TEST(Furnace, WhiteRoughBallsAreInvisible) {
  const TriMesh ball = ball_mesh({}, 1, 24);
  for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f})
    for (const model::Look& look :
         {model::Look::metal({1, 1, 1}, roughness), model::Look::plastic({1, 1, 1}, roughness)}) {
      const Vec3f mean = mean_of(render(before_uniform_sky({&ball, look}, 20), small_picture(32, 32, 16)));
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(mean[k], 1, 0.006f) << "roughness " << roughness
                                        << (look.type == model::LookType::metal ? ", metal" : ", plastic");
    }
}

TEST(Furnace, NoLookGivesLightAway) {
  const TriMesh ball = ball_mesh({}, 1, 24);
  for (const float roughness : {0.0f, 0.3f, 1.0f})
    for (const auto make : {model::Look::metal, model::Look::plastic, model::Look::wood}) {
      const model::Look look = make(srgb_of({0.9f, 0.6f, 0.2f}), roughness);
      const Vec3f mean = mean_of(render(before_uniform_sky({&ball, look}, 12), small_picture(24, 24, 16)));
      for (int k = 0; k < 3; ++k) {
        EXPECT_LT(mean[k], 1) << static_cast<int>(look.type);
        EXPECT_GT(mean[k], 0.08f) << static_cast<int>(look.type);
      }
      EXPECT_GT(mean.x, mean.y);
      EXPECT_GT(mean.y, mean.z);
    }
}

/// A grid of directions over the hemisphere, of equal projected area: the integral of f cos is the
/// mean of pi f.
template <class Each>
void over_hemisphere(int n, Each&& each) {
  const Frame up({0, 0, 1});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3f d = cosine_direction(up, (static_cast<float>(i) + 0.5f) / static_cast<float>(n),
                                       (static_cast<float>(j) + 0.5f) / static_cast<float>(n));
      each(up.local(d));
    }
}

/// The surfaces of all looks, in air and in water.
struct Surface {
  std::string name;
  std::unique_ptr<const Bsdf> bsdf;
};
std::vector<Surface> surfaces() {
  std::vector<Surface> all;
  for (std::size_t type = 0; type < model::look_type_names.size(); ++type)
    for (const double roughness : {0.4, 0.7, 1.0})
      for (const float outer : {1.0f, 1.333f}) {
        model::Look look;
        look.type = static_cast<model::LookType>(type), look.roughness = roughness;
        if (auto bsdf = traced(look)->bsdf(outer))
          all.push_back({std::string(model::look_type_names[type]) + " of roughness " + std::to_string(roughness) +
                             " in " + std::to_string(outer),
                         std::move(bsdf)});
      }
  model::Look plaster = model::Look::opaque({1, 1, 1}, 0.8);
  all.push_back({"plaster of the how-to", make_plaster(plaster)->bsdf(1)});
  return all;
}

const Vec3f mixed{0.9f, 0.5f, 0.1f};

Vec3f view_of(float c) { return {std::sqrt(1 - c * c), 0, c}; }

TEST(Surfaces, SamplesAreWorthWhatTheFormulaSays) {
  constexpr int n = 12;
  for (const Surface& s : surfaces())
    for (const float c : {0.95f, 0.5f, 0.2f})
      for (int lobe = 0; lobe < s.bsdf->lobes(); ++lobe)
        for (int i = 0; i < n * n; ++i) {
          const Vec3f view = view_of(c);
          const Bsdf::Sample drawn = s.bsdf->sample(lobe, view, mixed, (static_cast<float>(i % n) + 0.5f) / n,
                                                    (static_cast<float>(i / n) + 0.5f) / n);
          if (drawn.weight == Vec3f{}) continue;
          const float density = s.bsdf->pdf(lobe, view, drawn.light);
          const Vec3f worth = s.bsdf->eval(lobe, view, drawn.light, mixed) * (1 / density);
          for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(drawn.weight[k], worth[k], 2e-3f * worth[k] + 1e-5f) << s.name << ", lobe " << lobe;
        }
}

// Over cells of the hemisphere of equal solid angle the counts of samples are those of the
// density: Pearson's chi-square with a chance of 1e-4 a test to fail by luck, by the normal
// approximation of Wilson and Hilferty 1931.
TEST(Surfaces, SamplesHaveTheirDensity) {
  constexpr int across = 8, cells = across * across, fine = 24, drawn = 20000;
  for (const Surface& s : surfaces())
    for (const float c : {0.9f, 0.4f})
      for (int lobe = 0; lobe < s.bsdf->lobes(); ++lobe) {
        const Vec3f view = view_of(c);
        std::array<double, cells + 1> expected{}, counted{};
        for (int i = 0; i < across * fine; ++i)
          for (int j = 0; j < across * fine; ++j) {
            const float z = (static_cast<float>(i) + 0.5f) / (across * fine),
                        phi = 2 * pi * (static_cast<float>(j) + 0.5f) / (across * fine), r = std::sqrt(1 - z * z);
            expected[static_cast<std::size_t>(i / fine * across + j / fine)] +=
                static_cast<double>(s.bsdf->pdf(lobe, view, {r * std::cos(phi), r * std::sin(phi), z}) * 2 * pi) /
                (across * fine) / (across * fine);
          }
        double inside = 0;
        for (int k = 0; k < cells; ++k) inside += expected[static_cast<std::size_t>(k)];
        ASSERT_LT(inside, 1.01) << s.name;
        expected[cells] = std::max(0.0, 1 - inside);  // microfacets that send light into the surface
        for (std::uint32_t i = 0; i < drawn; ++i) {
          const float a = unit_float(hash32(2 * i + 1)), b = unit_float(hash32(2 * i + 2));
          const Bsdf::Sample one = s.bsdf->sample(lobe, view, mixed, a, b);
          if (one.weight == Vec3f{}) {
            ++counted[cells];
            continue;
          }
          float turn = std::atan2(one.light.y, one.light.x) / (2 * pi);
          turn -= std::floor(turn);
          const int row = std::min(across - 1, static_cast<int>(one.light.z * across)),
                    column = std::min(across - 1, static_cast<int>(turn * across));
          ++counted[static_cast<std::size_t>(row * across + column)];
        }
        double chi2 = 0, rest_expected = 0, rest_counted = 0;
        int free = -1;
        for (std::size_t k = 0; k <= cells; ++k) {
          if (expected[k] * drawn < 20) {
            rest_expected += expected[k] * drawn, rest_counted += counted[k];
            continue;
          }
          chi2 += std::pow(counted[k] - expected[k] * drawn, 2) / (expected[k] * drawn), ++free;
        }
        if (rest_expected > 5) chi2 += std::pow(rest_counted - rest_expected, 2) / rest_expected, ++free;
        ASSERT_GT(free, 3) << s.name;
        const double t = 2.0 / (9 * free), z = (std::cbrt(chi2 / free) - (1 - t)) / std::sqrt(t);
        EXPECT_LT(z, 3.72) << s.name << ", lobe " << lobe << ", cosine " << c << ": chi2 " << chi2 << " of " << free;
      }
}

TEST(Surfaces, AreTheSameBothWays) {
  const Vec3f a = normalized(Vec3f{0.3f, 0.2f, 0.6f});
  for (const Surface& s : surfaces())
    for (const Vec3f& b : {normalized(Vec3f{-0.7f, 0.1f, 0.3f}), normalized(Vec3f{-0.2f, -0.3f, 0.5f})}) {
      const Vec3f there = s.bsdf->eval(a, b, mixed) / b.z, back = s.bsdf->eval(b, a, mixed) / a.z;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(there[k], back[k], 1e-4f * there[k] + 1e-6f) << s.name;
        EXPECT_GT(there[k], 0) << s.name;
      }
    }
}

TEST(Surfaces, SendBackNoMoreThanArrives) {
  constexpr int n = 120;
  for (const Surface& s : surfaces())
    for (const float c : {0.95f, 0.5f, 0.15f}) {
      double all = 0;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          for (int lobe = 0; lobe < s.bsdf->lobes(); ++lobe)
            all += 2 * (i + 0.5) / n *
                   static_cast<double>(s.bsdf
                                           ->sample(lobe, view_of(c), {1, 1, 1},
                                                    1 - std::pow((static_cast<float>(i) + 0.5f) / n, 2.0f),
                                                    (static_cast<float>(j) + 0.5f) / n)
                                           .weight.y) /
                   (n * n);
      // The bound is that of tables of 48 entries.
      EXPECT_LT(all, 1.002) << s.name << ", cosine " << c;
      if (s.name.starts_with("plaster")) continue;
      EXPECT_GT(all, 0.998) << s.name << ", cosine " << c;
    }
}

TEST(Surfaces, TheListOfLooksStandsInTheGuide) {
  const std::string page = read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs" / "howto" / "looks.md");
  for (const std::string_view type : model::look_type_names)
    EXPECT_NE(page.find("\n| `" + std::string(type) + "` |"), page.npos) << type;
}

TEST(Surfaces, AMetalReflectsItsColorAhead) {
  const Conductor metal(0.05f);
  const Bsdf::Sample s = metal.sample(0, {0, 0, 1}, mixed, 0.3f, 0.6f);
  EXPECT_NEAR(s.light.z, 1, 1e-3f);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(s.weight[k], mixed[k], 0.01f);
  EXPECT_TRUE(metal.mirror(0));
  EXPECT_FALSE(Conductor(0.3f).mirror(0));
}

TEST(Surfaces, TheSunLightsThemAsItsDiscWould) {
  // A wide sun with its true radiance: what direct light gives must be what a bounce would find.
  const TriMesh plate = box_mesh({-1, -0.1f, -1}, {1, 0, 1});
  RenderScene scene = before_uniform_sky({&plate, model::Look::plastic(srgb_of({0.5f, 0.5f, 0.5f}), 0.6)}, 8);
  scene.camera.from = {0.2, 4, 0.1};
  scene.light.sun.strength = 5, scene.light.sun.elevation = 60, scene.light.sun.angle = 10;
  const Vec3f mean = mean_of(render(scene, small_picture(16, 16, 64)));
  const Sky sky(scene.light, true);
  const auto surface = traced(scene.objects[0].look)->bsdf(1);
  const Vec3f view = normalized(Vec3f{0.2f, 0.1f, 4});  // x, z, and up as z
  Vec3d expected;
  constexpr int n = 300;
  over_hemisphere(n, [&](const Vec3f& light) {
    const Vec3f f = surface->eval(view, light, {0.5f, 0.5f, 0.5f}) * (pi / light.z);
    expected += static_cast<Vec3d>(f * sky.radiance({light.x, light.z, light.y}, true)) / double(n * n);
  });
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], expected[k], 0.02 * expected[k]);
}

TEST(Wood, IsOfOnePieceAndItsGrainRunsAlong) {
  TextureFrame frame;
  frame.half = {0.2f, 0.05f, 0.02f};
  const WoodPattern look;
  const auto difference = [&](const Vec3f& step) {
    float sum = 0;
    for (int i = 0; i < 400; ++i) {
      const float t = static_cast<float>(i) / 400;
      const Vec3f p{0.3f * t - 0.15f, 0.08f * unit_float(hash32(static_cast<std::uint32_t>(i))) - 0.04f, 0.01f};
      sum += std::fabs(luminance(wood_color(look, frame, p, 0)) - luminance(wood_color(look, frame, p + step, 0)));
    }
    return sum / 400;
  };
  EXPECT_LT(difference({1e-6f, 1e-6f, 1e-6f}), 1e-3f);
  EXPECT_GT(difference({0, 0.004f, 0}), 3 * difference({0.004f, 0, 0})) << "across the grain and along it";
  EXPECT_LT(difference({0, 0.004f, 0}), 0.3f);
}

TEST(Wood, GoesWithItsBody) {
  TextureFrame rest, moved;
  moved.middle = {1, 2, 3};
  moved.x = {0, 1, 0}, moved.y = {0, 0, 1}, moved.z = {1, 0, 0};
  for (int i = 0; i < 20; ++i) {
    const Vec3f p{0.008f * static_cast<float>(i) - 0.08f, 0.03f, -0.05f + 0.004f * static_cast<float>(i)};
    const Vec3f q = moved.middle + moved.x * p.x + moved.y * p.y + moved.z * p.z;
    const Vec3f a = wood_color({}, rest, p, 0), b = wood_color({}, moved, q, 0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 2e-3f);
  }
}

TEST(Wood, FarAwayIsItsMean) {
  TextureFrame frame;
  const WoodPattern look;
  float low = 1, high = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3f p{0.001f * static_cast<float>(i), 0.0013f * static_cast<float>(i) - 0.05f, 0.02f};
    const float c = luminance(wood_color(look, frame, p, 0.1f));
    low = std::min(low, c), high = std::max(high, c);
  }
  EXPECT_LT(high / low, 1.25f);
}

}  // namespace
}  // namespace dreampm
