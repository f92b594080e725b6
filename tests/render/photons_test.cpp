// Caustics on bodies by photons.
#include "dreampm/render/photons.h"

#include <gtest/gtest.h>

#include "dreampm/base/parallel.h"
#include "dreampm/render/stage.h"
#include "shapes.h"

namespace dreampm {
namespace {

using namespace trace;

float irradiance(const PhotonMap& map, const Vec3f& p, const Vec3f& n) {
  float sum = 0;
  map.at(p, n, [&](const Vec3f& from, const Vec3f& e) {
    EXPECT_GT(dot(from, n), 0);
    sum += e.y;
  });
  return sum;
}

/// A plate at the bottom of a wide pool, without a floor below.
RenderScene pool(const TriMesh& water, const TriMesh& plate) {
  RenderScene s;
  s.basin = {{-2, -0.5f, -2}, {2, 1, 2}};
  s.stage.floor = model::Floor::none, s.stage.basin = model::Basin::none;
  s.physical = true;
  s.light.sun.angle = 0.5;
  s.objects = {{&water, model::Look::dielectric(1.333, {})}, {&plate, model::Look::opaque({0.8, 0.8, 0.8})}};
  return s;
}

TEST(Photons, UnderALevelSurfaceTheyKeepTheirEnergy) {
  const TriMesh water = box_mesh({-2, -0.3f, -2}, {2, 0, 2}), plate = box_mesh({-1, -0.2f, -1}, {1, -0.1f, 1});
  const RenderScene scene = pool(water, plate);
  const Geometry geometry(scene);
  const Sky sky(scene.light, true);
  const PhotonMap map(geometry, sky, Lamps{}, clear_bounds(scene, geometry), false, 400000, 3);
  double sum = 0;
  int n = 0;
  for (float x = -0.6f; x < 0.6f; x += 0.1f)
    for (float z = -0.6f; z < 0.6f; z += 0.1f) sum += irradiance(map, {x, -0.1f, z}, {0, 1, 0}), ++n;
  float cos_out;
  const float y = sky.sun_direction().y, pass = 1 - fresnel(y, 1 / 1.333f, cos_out);
  EXPECT_NEAR(sum / n, sky.sun_irradiance().y * y * pass, 0.02 * sky.sun_irradiance().y * y * pass);
}

TEST(Photons, ALensGathersThemOnABody) {
  const TriMesh lens = ball_mesh({0, 0.2f, 0}, 0.1f, 64), plate = box_mesh({-1, -0.1f, -1}, {1, 0, 1});
  RenderScene scene = pool(lens, plate);
  scene.light.sun.elevation = 90, scene.light.sun.angle = 0.3;
  const Geometry geometry(scene);
  const Sky sky(scene.light, true);
  const PhotonMap map(geometry, sky, Lamps{}, clear_bounds(scene, geometry), false, 100000, 3);
  EXPECT_GT(irradiance(map, {0, 0, 0}, {0, 1, 0}), 3 * sky.sun_irradiance().y) << "the focus";
  EXPECT_LT(irradiance(map, {0.085f, 0, 0}, {0, 1, 0}), 0.3f * sky.sun_irradiance().y) << "the dark round it";
  EXPECT_EQ(irradiance(map, {0.5f, 0, 0}, {0, 1, 0}), 0) << "what comes straight is not theirs";
}

TEST(Photons, APictureOfABodyUnderWaterIsTheSameForAnyThreadsAndShowsCaustics) {
  TriMesh water = box_mesh({-2, -0.3f, -2}, {2, 0, 2});
  const TriMesh lens = ball_mesh({0, 0.1f, 0}, 0.1f, 32), plate = box_mesh({-1, -0.3f, -1}, {1, -0.2f, 1});
  RenderScene scene = pool(water, plate);
  scene.objects.push_back({&lens, model::Look::dielectric(1.5, {})});
  scene.camera.fit_basin = false;
  scene.camera.from = {0.3, 3, 0.2}, scene.camera.to = {0, 0, 0}, scene.camera.fov = 20;
  RenderSettings settings = small_picture(24, 24, 4);
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return render(scene, settings).linear;
  };
  const auto one = with(1);
  EXPECT_EQ(one, with(2));
  settings.caustics = false;
  EXPECT_NE(one, with(2));
}

}  // namespace
}  // namespace dreampm
