// Water wrapped from particles, in glass and around glass: rays against Snell and Fresnel.
#include <gtest/gtest.h>

#include "dreampm/math/rng.h"
#include "dreampm/render/color.h"
#include "dreampm/render/interface.h"
#include "dreampm/surface/surface.h"
#include "faces.h"
#include "shapes.h"
#include "solid_of.h"

namespace dreampm {
namespace {

using namespace trace;

constexpr float glass_ior = 1.5f, water_ior = 1.333f, spacing = 0.02f;

/// Particles on a jittered lattice, where `keep` says.
template <class Keep>
std::vector<Vec3f> particles_where(const Keep& keep) {
  std::vector<Vec3f> points;
  std::uint64_t n = 0;
  constexpr int half = 25;
  for (int k = -half; k < half; ++k)
    for (int j = -half; j < half; ++j)
      for (int i = -half; i < half; ++i) {
        const auto off = [&] { return 0.5f + 0.35f * (2 * static_cast<float>(uniform(3, n++)) - 1); };
        const float x = off(), y = off(), z = off();
        const Vec3f p =
            Vec3f{static_cast<float>(i) + x, static_cast<float>(j) + y, static_cast<float>(k) + z} * spacing;
        if (keep(p)) points.push_back(p);
      }
  return points;
}

/// Water wrapped beside glass, and both in a scene.
struct WetGlass {
  WetGlass(TriMesh drawn, const Shape& shape, const std::vector<Vec3f>& points, float overlap = 0.5f)
      : glass(std::move(drawn)) {
    SurfaceInput input{.positions = points, .spacing = spacing};
    input.solids = {solid_of(shape)};
    SurfaceSettings settings;
    settings.overlap = overlap;
    water = reconstruct(input, settings).mesh;
    scene = before_uniform_sky({&water, model::Look::dielectric(water_ior, {})}, 1);
    scene.objects.push_back({&glass, model::Look::dielectric(glass_ior, {}), {}, {}, 1});
  }
  TriMesh glass, water;
  RenderScene scene;
};

/// The inner faces of a glass box, which water fills: [-a, a]^3 within [-b, b]^3.
constexpr float a = 0.3f, b = 0.4f;
TriMesh hollow_box() {
  TriMesh mesh = box_mesh({-b, -b, -b}, {b, b, b});
  const TriMesh hollow = box_mesh({-a, -a, -a}, {a, a, a});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  for (const auto& [i, j, k] : hollow.triangles) mesh.triangles.push_back({first + i, first + k, first + j});
  return mesh;
}
Shape box_shape() { return Shape::box({-b, -b, -b}, {b, b, b}) - Shape::box({-a, -a, -a}, {a, a, a}); }

TEST(WetGlass, FromEverySideGlassAndWaterHaveOneFace) {
  const auto points =
      particles_where([](const Vec3f& p) { return std::abs(p.x) < a && std::abs(p.y) < a && std::abs(p.z) < a; });
  const WetGlass wet(hollow_box(), box_shape(), points);
  const Geometry geometry(wet.scene);
  std::uint64_t n = 0;
  const auto next = [&] { return 2 * static_cast<float>(uniform(11, n++)) - 1; };
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f})
      for (int ray = 0; ray < 60; ++ray) {
        // In through one side and out of the other, aimed anywhere at the inner face, its edges
        // too.
        Vec3f to{next() * 0.95f * a, next() * 0.95f * a, next() * 0.95f * a},
            d{0.15f * next(), 0.15f * next(), 0.15f * next()};
        to[axis] = -side * a, d[axis] = side;
        d = normalized(d);
        const Vec3f o = to - d * 2.0f;
        const auto list = faces(geometry, o, d);
        ASSERT_GE(list.size(), 4u);
        const float planes[4] = {-b, -a, a, b}, media[5] = {1, glass_ior, water_ior, glass_ior, 1};
        Vec3f way = d;
        for (std::size_t i = 0; i < 4; ++i) {
          const Face& f = list[i];
          if (std::abs(std::abs(f.at[axis]) - std::abs(planes[i])) > 1e-4f) {
            EXPECT_GE(i, 2u) << "a side wall is met inside at most";
            break;
          }
          float cos_out;
          const float cos_in = std::abs(way[axis]), eta = media[i] / media[i + 1];
          ASSERT_EQ(f.before, media[i]);
          ASSERT_EQ(f.behind, media[i + 1]);
          ASSERT_NEAR(f.reflectance, fresnel(cos_in, eta, cos_out), 1e-5f);
          for (const int c : {(axis + 1) % 3, (axis + 2) % 3}) ASSERT_NEAR(f.direction[c], eta * way[c], 1e-4f);
          way = f.direction;
        }
      }
}

TEST(WetGlass, WithoutOverlapThereIsAirInTheCorners) {
  // The control of the test above.
  const auto points =
      particles_where([](const Vec3f& p) { return std::abs(p.x) < a && std::abs(p.y) < a && std::abs(p.z) < a; });
  const WetGlass dry(hollow_box(), box_shape(), points, 0);
  const Geometry geometry(dry.scene);
  int air_gaps = 0;
  for (int ray = 0; ray < 200; ++ray) {
    const float y = 0.98f * a * (2 * static_cast<float>(uniform(5, static_cast<std::uint64_t>(ray))) - 1);
    for (const Face& f : faces(geometry, {-2, y, 0.999f * a}, {1, 0, 0}))
      air_gaps += f.before == glass_ior && f.behind == 1 && std::abs(f.at.x) < 0.9f * b;
  }
  EXPECT_GT(air_gaps, 20);
}

TEST(WetGlass, ABallOfGlassInWater) {
  const float radius = 0.2f, half = 0.4f;
  const auto points = particles_where([&](const Vec3f& p) {
    return length(p) > radius && std::abs(p.x) < half && std::abs(p.y) < half && std::abs(p.z) < half;
  });
  const WetGlass wet(ball_mesh({}, radius, 160), Shape::sphere({}, radius), points);
  const Geometry geometry(wet.scene);
  std::uint64_t n = 0;
  int met = 0;
  for (int ray = 0; ray < 400; ++ray) {
    const auto next = [&] { return 2 * static_cast<float>(uniform(23, n++)) - 1; };
    const Vec3f to = Vec3f{next(), next(), next()} * (0.5f * radius), d = normalized(Vec3f{next(), next(), next()});
    const auto list = faces(geometry, to - d * 2.0f, d);
    // Air, water, glass, water, air: the water's own faces are as rough as its particles.
    ASSERT_GE(list.size(), 4u);
    std::vector<Face> ball;
    for (const Face& f : list)
      if (length(f.at) < 1.2f * radius) ball.push_back(f);
    ASSERT_EQ(ball.size(), 2u) << "no film of air";
    EXPECT_EQ(ball[0].before, water_ior);
    EXPECT_EQ(ball[0].behind, glass_ior);
    EXPECT_EQ(ball[1].before, glass_ior);
    EXPECT_EQ(ball[1].behind, water_ior);
    // Within the ball the angles at both ends are the same: sine = n sine by Snell, and what
    // reflects is the same at both.
    EXPECT_NEAR(ball[0].reflectance, ball[1].reflectance, 2e-3f);
    for (const Face& f : ball) EXPECT_NEAR(length(f.at), radius, 1e-3f * radius);
    const Vec3f chord = normalized(ball[1].at - ball[0].at);
    const float cos_in = -dot(chord, normalized(ball[0].at)), sine = std::sqrt(1 - cos_in * cos_in);
    float cos_out;
    EXPECT_NEAR(ball[1].reflectance, fresnel(cos_in, glass_ior / water_ior, cos_out), 2e-3f);
    const float out = dot(ball[1].direction, normalized(ball[1].at));
    EXPECT_NEAR(std::sqrt(1 - out * out), sine * glass_ior / water_ior, 1e-2f);
    ++met;
  }
  EXPECT_EQ(met, 400);
}

TEST(WetGlass, AHollowBlockHalfFull) {
  const auto points =
      particles_where([](const Vec3f& p) { return std::abs(p.x) < a && p.y > -a && p.y < 0 && std::abs(p.z) < a; });
  const WetGlass wet(hollow_box(), box_shape(), points);
  const Geometry geometry(wet.scene);
  for (int ray = 0; ray < 300; ++ray) {
    const auto at = [&](int k) {
      return 2 * static_cast<float>(uniform(31, static_cast<std::uint64_t>(3 * ray + k))) - 1;
    };
    const float z = 0.97f * a * at(1);
    // Below the level water, above it air; two spacings around it are not asked.
    for (const bool wetted : {true, false}) {
      const float y = wetted ? -0.03f - 0.26f * std::abs(at(0)) : 0.04f + 0.25f * std::abs(at(0));
      const auto list = faces(geometry, {-2, y, z}, {1, 0, 0});
      ASSERT_EQ(list.size(), 4u) << y << " " << z;
      const float inner = wetted ? water_ior : 1;
      const float media[5] = {1, glass_ior, inner, glass_ior, 1};
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(list[i].before, media[i]);
        EXPECT_EQ(list[i].behind, media[i + 1]);
        float cos_out;
        EXPECT_NEAR(list[i].reflectance, fresnel(1, media[i] / media[i + 1], cos_out), 1e-5f);
      }
    }
  }
}

}  // namespace
}  // namespace dreampm
