#include "dreampm/render/lamps.h"

namespace dreampm::trace {

const Vec3f* Lamps::met(const Vec3f& o, const Vec3f& d, float reach) const {
  const Vec3f* nearest = nullptr;
  for (const Lamp& lamp : lamps_) {
    const Vec3f to = lamp.center - o;
    const float along = dot(to, d), off2 = length2(to) - along * along, r2 = lamp.radius * lamp.radius;
    if (off2 >= r2) continue;
    const float t = along - std::sqrt(r2 - off2);
    if (t > 0 && t < reach) reach = t, nearest = &lamp.radiance;
  }
  return nearest;
}

LightSample Lamps::draw(const Vec3f& p, Sampler& random) const {
  const auto solid_angle = [&](const Lamp& lamp) {
    const float s2 = std::min(1.0f, lamp.radius * lamp.radius / std::max(1e-20f, length2(lamp.center - p)));
    return 2 * pi * s2 / (1 + std::sqrt(1 - s2));
  };
  float all = 0;
  for (const Lamp& lamp : lamps_) all += solid_angle(lamp) * luminance(lamp.radiance);
  float a = random.next() * all;
  const float b = random.next();
  for (const Lamp& lamp : lamps_) {
    const float angle = solid_angle(lamp), share = angle * luminance(lamp.radiance);
    if (a >= share && &lamp != &lamps_.back()) {
      a -= share;
      continue;
    }
    const Vec3f to = lamp.center - p;
    const float c = 1 - std::min(1.0f, a / share) * angle / (2 * pi), s = std::sqrt(std::max(0.0f, 1 - c * c)),
                phi = 2 * pi * b;
    const Vec3f d = Frame(normalized(to)).world(s * std::cos(phi), s * std::sin(phi), c);
    const float along = dot(to, d), off2 = std::max(0.0f, length2(to) - along * along);
    return {d, along - std::sqrt(std::max(0.0f, lamp.radius * lamp.radius - off2)),
            lamp.radiance * (angle * all / share)};
  }
  return {};
}

}  // namespace dreampm::trace
