#include "dreampm/math/pigments.h"

#include <gtest/gtest.h>

#include "dreampm/math/srgb.h"

namespace dreampm {
namespace {

Vec3f linear(double r, double g, double b) { return linear_color(Vec3d{r, g, b}); }

Vec3f mixed(std::initializer_list<std::pair<Vec3f, float>> parts, Mixing mixing) {
  PigmentMix mix(mixing);
  for (const auto& [color, amount] : parts) mix.add(Pigment::of(color, mixing), amount);
  return mix.color();
}
/// In sRGB, as people judge colors.
Vec3f seen(const Vec3f& linear) {
  return {srgb_from_linear(linear.x), srgb_from_linear(linear.y), srgb_from_linear(linear.z)};
}
float farthest(const Vec3f& a, const Vec3f& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

class Pigments : public testing::TestWithParam<Mixing> {};
INSTANTIATE_TEST_SUITE_P(Both, Pigments, testing::Values(Mixing::opaque, Mixing::clear));

TEST_P(Pigments, BlueAndYellowAreGreen) {
  const std::pair<Vec3f, Vec3f> pairs[] = {{linear(0, 0.13, 0.52), linear(0.99, 0.83, 0)},  // cobalt, cadmium
                                           {linear(0.1, 0.3, 0.8), linear(1, 0.9, 0.1)},
                                           {linear(0, 0, 1), linear(1, 1, 0)}};
  for (const auto& [blue, yellow] : pairs) {
    const Vec3f got = seen(mixed({{blue, 1}, {yellow, 1}}, GetParam()));
    EXPECT_GT(got.y, got.x + 0.08f);
    EXPECT_GT(got.y, got.z + 0.08f);
    // Light would give gray or pink.
    const Vec3f light = seen((blue + yellow) * 0.5f);
    EXPECT_LT(light.y, light.x + 0.01f);
  }
}

TEST_P(Pigments, AColorIsWhatItWas) {
  for (const float r : {0.0f, 0.03f, 0.4f, 1.0f})
    for (const float g : {0.0f, 0.2f, 1.0f})
      for (const float b : {0.0f, 0.5f, 1.0f}) {
        const Vec3f color{r, g, b};
        EXPECT_LT(farthest(mixed({{color, 1}}, GetParam()), color), 1e-5f) << r << ' ' << g << ' ' << b;
        EXPECT_LT(farthest(mixed({{color, 0.3f}, {color, 5}}, GetParam()), color), 1e-5f) << r << ' ' << g << ' ' << b;
      }
}

TEST_P(Pigments, TheOrderDoesNotMatterNorTheUnitOfAmounts) {
  const Vec3f a = linear(0.8, 0.2, 0.1), b = linear(0.1, 0.5, 0.9), c = linear(0.9, 0.9, 0.4);
  const Vec3f once = mixed({{a, 1}, {b, 2}, {c, 3}}, GetParam());
  EXPECT_LT(farthest(once, mixed({{c, 3}, {a, 1}, {b, 2}}, GetParam())), 1e-5f);
  EXPECT_LT(farthest(once, mixed({{b, 20}, {c, 30}, {a, 10}}, GetParam())), 1e-5f);
  // Nor whether parts were mixed before: sums of sums are sums.
  PigmentMix whole(GetParam());
  for (int i = 0; i < 6; ++i) whole.add(Pigment::of(i < 1 ? a : i < 3 ? b : c, GetParam()), 1);
  EXPECT_LT(farthest(once, whole.color()), 1e-5f);
}

TEST_P(Pigments, WhiteAndBlackAreTheEnds) {
  const Vec3f white{1, 1, 1}, black{}, red = linear(0.9, 0.1, 0.1);
  // The more white the lighter, up to white; and black the darker.
  float before = red.y;
  for (const float share : {0.2f, 0.5f, 0.8f, 0.99f}) {
    const Vec3f pink = mixed({{red, 1 - share}, {white, share}}, GetParam());
    EXPECT_GT(pink.y, before);
    EXPECT_GE(pink.x, pink.y - 1e-5f);
    before = pink.y;
  }
  EXPECT_LT(farthest(mixed({{red, 1e-6f}, {white, 1}}, GetParam()), white), 0.01f);
  EXPECT_LT(farthest(mixed({{red, 1e-6f}, {black, 1}}, GetParam()), black), 1e-4f);
  const Vec3f gray = mixed({{white, 1}, {black, 1}}, GetParam());
  EXPECT_LT(farthest(gray, {gray.x, gray.x, gray.x}), 1e-4f) << "gray has no hue";
  EXPECT_LT(gray.x, 0.5f) << "black dyes more than white lightens";
}

TEST(Pigments, ClearMatterAbsorbsWhatItsPartsDo) {
  // Gray has one reflectance for all light: half of each is the geometric mean.
  const Vec3f got = mixed({{Vec3f{0.9f, 0.9f, 0.9f}, 1}, {Vec3f{0.1f, 0.1f, 0.1f}, 1}}, Mixing::clear);
  EXPECT_LT(farthest(got, {0.3f, 0.3f, 0.3f}), 1e-4f);
}

TEST(Pigments, OpaqueMatterMixesAsKubelkaAndMunkSay) {
  const auto ratio = [](double r) { return (1 - r) * (1 - r) / (2 * r); };
  const double k = 0.25 * ratio(0.8) + 0.75 * ratio(0.2), r = 1 + k - std::sqrt(k * k + 2 * k);
  const Vec3f got = mixed({{Vec3f{0.8f, 0.8f, 0.8f}, 1}, {Vec3f{0.2f, 0.2f, 0.2f}, 3}}, Mixing::opaque);
  EXPECT_LT(farthest(got, Vec3f{1, 1, 1} * static_cast<float>(r)), 1e-4f);
}

TEST(Pigments, BandsAreWhiteTogether) {
  Vec3f light{};
  for (std::size_t b = 0; b < pigments::band_count; ++b) {
    const Vec3f& p = pigments::tables().primary[b];
    EXPECT_NEAR(p.x + p.y + p.z, 1, 1e-6f);
    for (int c = 0; c < 3; ++c) EXPECT_GE(p[c], 0);
    light += pigments::tables().light[b];
  }
  EXPECT_LT(farthest(light, {1, 1, 1}), 1e-5f);
  // Red light is at the long end, blue at the short one.
  EXPECT_GT(pigments::tables().light[8].x, 0.3f);
  EXPECT_GT(pigments::tables().light[2].z, 0.3f);
}

}  // namespace
}  // namespace dreampm
