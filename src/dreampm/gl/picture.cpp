#include "dreampm/gl/picture.h"

#include <algorithm>

namespace dreampm::gl {

Theme light_theme() {
  Theme t;
  t.background_low = {0.84f, 0.88f, 0.92f};
  t.background_high = {0.56f, 0.68f, 0.82f};
  t.sky_low = {0.93f, 0.95f, 0.97f};
  t.sky_high = {0.50f, 0.68f, 0.90f};
  t.ambient_low = {0.42f, 0.41f, 0.40f};
  t.ambient_high = {0.62f, 0.66f, 0.72f};
  t.floor_bright = {0.81f, 0.79f, 0.755f};
  t.floor_dark = {0.71f, 0.685f, 0.645f};
  t.floor_grout = {0.57f, 0.55f, 0.51f};
  t.outline = {0.25f, 0.30f, 0.36f};
  return t;
}

Theme dark_theme() {
  Theme t;
  t.background_low = {0.17f, 0.19f, 0.22f};
  t.background_high = {0.07f, 0.08f, 0.10f};
  t.sky_low = {0.72f, 0.78f, 0.86f};
  t.sky_high = {0.16f, 0.24f, 0.36f};
  t.ambient_low = {0.30f, 0.30f, 0.32f};
  t.ambient_high = {0.50f, 0.54f, 0.60f};
  t.floor_bright = {0.36f, 0.37f, 0.39f};
  t.floor_dark = {0.30f, 0.31f, 0.33f};
  t.floor_grout = {0.21f, 0.22f, 0.24f};
  t.outline = {0.62f, 0.68f, 0.76f};
  return t;
}

std::array<PointLight, 2> lights_for(const Box3f& domain) {
  std::array<PointLight, 2> lights = Picture{}.lights;
  const Vec3f size = domain.size();
  const float side = std::max({size.x, size.y, size.z});
  const Vec3f foot{domain.center().x, domain.min.y, domain.center().z};
  for (PointLight& light : lights) light.position = foot + (light.position - Vec3f{0.5f, 0, 0.5f}) * side;
  return lights;
}

}  // namespace dreampm::gl
