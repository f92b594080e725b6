// Glass beside water beside air: what overlaps, what leaves a gap, against Snell and Fresnel.
#include <gtest/gtest.h>

#include "dreampm/render/color.h"
#include "dreampm/render/interface.h"
#include "faces.h"
#include "shapes.h"

namespace dreampm {
namespace {

using namespace trace;

constexpr float glass_ior = 1.5f, water_ior = 1.333f;

/// A slab of glass for x in [-0.2, 0], water from `water_from` to 0.4; both reach far in y and z.
struct Slabs {
  explicit Slabs(float water_from)
      : glass(box_mesh({-0.2f, -0.9f, -0.9f}, {0, 0.9f, 0.9f})),
        water(box_mesh({water_from, -0.8f, -0.8f}, {0.4f, 0.8f, 0.8f})) {
    scene = before_uniform_sky({&water, model::Look::dielectric(water_ior, {})}, 1);
    scene.objects.push_back({&glass, model::Look::dielectric(glass_ior, {}), {}, {}, 1});
  }
  TriMesh glass, water;
  RenderScene scene;
};

/// Of the direction behind a face, from the x axis.
float sine_of(const Face& f) { return std::hypot(f.direction.y, f.direction.z); }

void expect_one_interface(const Slabs& slabs, float sine) {
  const Geometry geometry(slabs.scene);
  const Vec3f there{std::sqrt(1 - sine * sine), sine, 0}, back{-there.x, sine, 0};
  const auto forth = faces(geometry, {-1, -0.4f, 0}, there), again = faces(geometry, {1, -0.4f, 0}, back);
  ASSERT_EQ(forth.size(), 3u);
  ASSERT_EQ(again.size(), 3u);
  const float x[3] = {-0.2f, 0, 0.4f}, n[4] = {1, glass_ior, water_ior, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    float cos_out;
    const float inside = sine / n[i], share = fresnel(std::sqrt(1 - inside * inside), n[i] / n[i + 1], cos_out);
    EXPECT_NEAR(forth[i].at.x, x[i], 1e-4f);
    EXPECT_NEAR(sine_of(forth[i]), sine / n[i + 1], 1e-4f) << "Snell";
    EXPECT_NEAR(forth[i].reflectance, share, 1e-5f) << "Fresnel, by the relative index";
    EXPECT_NEAR(again[2 - i].at.x, x[i], 1e-4f);
    EXPECT_NEAR(sine_of(again[2 - i]), sine / n[i], 1e-4f);
    EXPECT_NEAR(again[2 - i].reflectance, share, 1e-5f) << "the same both ways";
  }
}

TEST(Nested, WaterThatReachesIntoGlassHasOneFaceWithIt) {
  for (const float sine : {0.0f, 0.3f, 0.6f}) expect_one_interface(Slabs(-0.03f), sine);
}

TEST(Nested, WaterThatStopsShortOfGlassLeavesAir) {
  const Slabs apart(0.02f);
  EXPECT_EQ(faces(Geometry(apart.scene), {-1, -0.4f, 0}, {1, 0, 0}).size(), 4u);
}

TEST(Nested, TheRayKnowsWhereItStarts) {
  const Slabs slabs(-0.03f);
  const Geometry geometry(slabs.scene);
  // In the water: the first face is the glass.
  Media media;
  const Vec3f o{0.2f, 0, 0}, d{-1, 0, 0};
  Hit hit = cast_visible(geometry, o, d, media);
  EXPECT_EQ(hit.object, 1);
  // A ray that does not know learns it from the first face that it meets from inside.
  media = {};
  hit = cast_visible(geometry, o, {1, 0, 0}, media);
  EXPECT_EQ(hit.object, 0);
  EXPECT_EQ(media.top(), 0);
}

TEST(Nested, MediaKeepTheirRank) {
  const Slabs slabs(-0.03f);
  const Geometry geometry(slabs.scene);
  Media media;
  EXPECT_EQ(media.top(), air);
  media.add(geometry, 1), media.add(geometry, 0), media.add(geometry, 1);
  EXPECT_EQ(media.top(), 1);
  media.remove(1);
  EXPECT_EQ(media.top(), 0);
  media.remove(1), media.remove(0);
  EXPECT_EQ(media.top(), air);
}

TEST(Furnace, WaterInGlassIsInvisible) {
  const TriMesh outside = ball_mesh({}, 1, 48), inside = ball_mesh({0, 0, 0.45f}, 0.8f, 48);
  auto scene = before_uniform_sky({&inside, model::Look::dielectric(water_ior, {})}, 30);
  scene.objects.push_back({&outside, model::Look::dielectric(glass_ior, {}), {}, {}, 1});
  for (const bool water_first : {false, true}) {
    scene.objects[1].priority = water_first ? -1 : 1;
    const Vec3f mean = mean_of(render(scene, small_picture(32, 32, 16)));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], 1, 0.012f);
  }
}

}  // namespace
}  // namespace dreampm
