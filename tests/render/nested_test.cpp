// Glass beside water beside air: what overlaps, what leaves a gap, against Snell and Fresnel.
#include <gtest/gtest.h>

#include <optional>

#include "dreampm/render/color.h"
#include "dreampm/render/interface.h"
#include "dreampm/render/wetting.h"
#include "shapes.h"

namespace dreampm {
namespace {

using namespace trace;

constexpr float glass_ior = 1.5f, water_ior = 1.333f;

/// A slab of glass for x in [-0.2, 0], water from `water_from` to 0.4; both reach far in y and z.
struct Slabs {
  explicit Slabs(float water_from, float wetting = 0)
      : glass(box_mesh({-0.2f, -0.9f, -0.9f}, {0, 0.9f, 0.9f})),
        water(box_mesh({water_from, -0.8f, -0.8f}, {0.4f, 0.8f, 0.8f})) {
    scene = before_uniform_sky({&water, model::Look::dielectric(water_ior, {})}, 1);
    scene.objects.push_back({&glass, model::Look::dielectric(glass_ior, {}), {}, {}, 1});
    scene.wetting = wetting;
  }
  TriMesh glass, water;
  RenderScene scene;
};

struct Event {
  float x;
  float reflectance;
  float sine;  ///< behind the face, from the x axis
};

/// The faces that a ray meets which is always let through.
std::vector<Event> events(const Geometry& geometry, Vec3f o, Vec3f d) {
  std::vector<Event> list;
  Media media;
  for (int i = 0; i < 10; ++i) {
    const Hit hit = cast_visible(geometry, o, d, media);
    if (hit.kind != Kind::dielectric) break;
    const Split s = split_light(geometry, hit, d, media);
    const Vec3f p = o + d * hit.t;
    o = p - s.side * geometry.epsilon(), d = s.refracted, media = s.refracted_media;
    list.push_back({p.x, s.reflectance, std::sqrt(d.y * d.y + d.z * d.z)});
  }
  return list;
}

void expect_one_interface(const Slabs& slabs, float sine) {
  const Geometry geometry(slabs.scene);
  const Vec3f there{std::sqrt(1 - sine * sine), sine, 0}, back{-there.x, sine, 0};
  const auto forth = events(geometry, {-1, -0.4f, 0}, there), again = events(geometry, {1, -0.4f, 0}, back);
  ASSERT_EQ(forth.size(), 3u);
  ASSERT_EQ(again.size(), 3u);
  const float x[3] = {-0.2f, 0, 0.4f}, n[4] = {1, glass_ior, water_ior, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    float cos_out;
    const float inside = sine / n[i], share = fresnel(std::sqrt(1 - inside * inside), n[i] / n[i + 1], cos_out);
    EXPECT_NEAR(forth[i].x, x[i], 1e-4f);
    EXPECT_NEAR(forth[i].sine, sine / n[i + 1], 1e-4f) << "Snell";
    EXPECT_NEAR(forth[i].reflectance, share, 1e-5f) << "Fresnel, by the relative index";
    EXPECT_NEAR(again[2 - i].x, x[i], 1e-4f);
    EXPECT_NEAR(again[2 - i].sine, sine / n[i], 1e-4f);
    EXPECT_NEAR(again[2 - i].reflectance, share, 1e-5f) << "the same both ways";
  }
}

TEST(Nested, WaterThatReachesIntoGlassHasOneFaceWithIt) {
  for (const float sine : {0.0f, 0.3f, 0.6f}) expect_one_interface(Slabs(-0.03f), sine);
}

TEST(Nested, WaterThatStopsShortOfGlassTouchesIt) {
  for (const float gap : {0.0f, 0.005f, 0.02f}) expect_one_interface(Slabs(gap, 0.05f), 0.3f);
  // Without wetting there is air between.
  const Slabs apart(0.02f);
  EXPECT_EQ(events(Geometry(apart.scene), {-1, -0.4f, 0}, {1, 0, 0}).size(), 4u);
}

TEST(Nested, AWallOfGlassIsNotPierced) {
  // 5 mm of glass, with water that would be drawn 1 cm deep into it.
  Slabs thin(0.01f, 0.05f);
  thin.glass = box_mesh({-0.005f, -0.9f, -0.9f}, {0, 0.9f, 0.9f});
  const auto list = events(Geometry(thin.scene), {-1, -0.4f, 0}, {1, 0, 0});
  ASSERT_EQ(list.size(), 3u);
  EXPECT_NEAR(list[0].x, -0.005f, 1e-4f);
  EXPECT_NEAR(list[1].x, 0, 1e-4f);
}

TEST(Nested, OnlyWhatFacesTheGlassIsDrawnToIt) {
  // A film of 2 cm on the glass, and water that is far away.
  Slabs film(0.01f, 0.05f);
  film.water = box_mesh({0.01f, -0.8f, -0.8f}, {0.03f, 0.8f, 0.8f});
  for (const Vec3f& v : film.water.vertices) film.water.normals.push_back({v.x < 0.02f ? -1.0f : 1.0f, 0, 0});
  const auto wet = wetted(film.scene, film.scene.objects[0], 1e-5f);
  ASSERT_TRUE(wet);
  for (std::size_t v = 0; v < wet->vertices.size(); ++v) {
    const float before = film.water.vertices[v].x, after = wet->vertices[v].x;
    if (before < 0.02f)
      EXPECT_LT(after, 0);
    else
      EXPECT_EQ(after, before) << "the film stays a film";
  }
  Slabs far(0.2f, 0.05f);
  const auto same = wetted(far.scene, far.scene.objects[0], 1e-5f);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->vertices, far.water.vertices);
  EXPECT_FALSE(wetted(far.scene, far.scene.objects[1], 1e-5f)) << "glass does not move";
}

TEST(Nested, WaterFillsTheCornersOfGlass) {
  // A corner of three walls, and water that is round where it should be sharp.
  TriMesh walls = box_mesh({-0.2f, -0.2f, -0.2f}, {0, 1, 1});
  for (const TriMesh& wall : {box_mesh({-0.2f, -0.2f, -0.2f}, {1, 0, 1}), box_mesh({-0.2f, -0.2f, -0.2f}, {1, 1, 0})}) {
    const auto first = static_cast<std::uint32_t>(walls.vertices.size());
    walls.vertices.insert(walls.vertices.end(), wall.vertices.begin(), wall.vertices.end());
    for (const auto& [i, j, k] : wall.triangles) walls.triangles.push_back({first + i, first + j, first + k});
  }
  TriMesh water;
  for (const Vec3f& n : {Vec3f{-1, 0, 0}, normalized(Vec3f{-1, -1, 0}), normalized(Vec3f{-1, -1, -1})}) {
    water.vertices.push_back(Vec3f{0.03f, 0.03f, 0.03f} + n * 0.02f);
    water.normals.push_back(n);
  }
  RenderScene scene = before_uniform_sky({&water, model::Look::dielectric(water_ior, {})}, 1);
  scene.objects.push_back({&walls, model::Look::dielectric(glass_ior, {}), {}, {}, 1});
  scene.wetting = 0.05f;
  const auto wet = wetted(scene, scene.objects[0], 1e-5f);
  ASSERT_TRUE(wet);
  const auto &side = wet->vertices[0], &edge = wet->vertices[1], &corner = wet->vertices[2];
  EXPECT_LT(side.x, 0);
  EXPECT_LT(std::max(edge.x, edge.y), 0);
  EXPECT_LT(std::max(corner.x, std::max(corner.y, corner.z)), 0);
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
