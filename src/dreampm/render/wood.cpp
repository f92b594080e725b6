#include "dreampm/render/wood.h"

#include "dreampm/render/color.h"
#include "dreampm/render/glossy.h"
#include "dreampm/render/looks.h"

namespace dreampm::trace {
namespace {

/// Rings in the middle extent of an object that gives no width.
constexpr float rings_across = 11;
/// Late wood, fibers and pores by the early wood's reflectance.
const Vec3f late_wood{0.50f, 0.40f, 0.31f}, pore_wood{0.62f, 0.54f, 0.47f};

float lattice(int i, int j, int k) {
  return unit_float(hash32(static_cast<std::uint32_t>(i) * 0x8da6b343u ^ static_cast<std::uint32_t>(j) * 0xd8163841u ^
                           static_cast<std::uint32_t>(k) * 0xcb1ab31fu));
}

/// Smooth noise in [0, 1] with one lattice cell per unit.
float noise(float x, float y, float z) {
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const int i = static_cast<int>(fx), j = static_cast<int>(fy), k = static_cast<int>(fz);
  const float u = smoothstep(0, 1, x - fx), v = smoothstep(0, 1, y - fy), w = smoothstep(0, 1, z - fz);
  const auto plane = [&](int kk) {
    return mix(mix(lattice(i, j, kk), lattice(i + 1, j, kk), u),
               mix(lattice(i, j + 1, kk), lattice(i + 1, j + 1, kk), u), v);
  };
  return mix(plane(k), plane(k + 1), w);
}

/// Wood under a satin varnish, in the frame of its object.
class Wood final : public Look {
 public:
  using Look::Look;
  std::unique_ptr<const Bsdf> bsdf(float outer_ior) const override {
    return std::make_unique<Coated>(static_cast<float>(model().roughness), outer_ior);
  }
  Vec3f color_at(const SurfacePoint& point) const override {
    return wood_color(pattern_, point.frame, point.position, point.footprint);
  }

 private:
  WoodPattern pattern_{Look::color(), static_cast<float>(model().ring.value_or(0))};
};

}  // namespace

std::unique_ptr<const Look> make_wood(const model::Look& look) { return std::make_unique<Wood>(look); }

Vec3f wood_color(const WoodPattern& look, const TextureFrame& frame, const Vec3f& p, float footprint) {
  const float middle_half =
      std::max(std::min(frame.half.x, frame.half.y), std::min(std::max(frame.half.x, frame.half.y), frame.half.z));
  const float ring = look.ring > 0 ? look.ring : std::max(1e-6f, 2 * middle_half / rings_across);
  const Vec3f from = p - frame.middle;
  // in rings
  const float x = dot(from, frame.x) / ring, y = dot(from, frame.y) / ring, z = dot(from, frame.z) / ring;
  const float seen = footprint / ring;
  // Each object is sawn from another place of the trunk.
  const float own = lattice(static_cast<int>(frame.half.x * 4096), static_cast<int>(frame.half.y * 4096),
                            static_cast<int>(frame.half.z * 4096));
  // The trunk tapers and bends a little, so that sawn sides show arches.
  const float bend = 1.6f * (noise(x * 0.045f + 31 * own, 0.5f, 7.3f) - 0.5f);
  const float py = y - (0.15f + 0.5f * own) * middle_half / ring + bend;
  const float pz = z + 1.15f * std::max(frame.half.z / ring, 3.0f) + 0.7f * bend;
  float r = std::sqrt(py * py + pz * pz) - 0.035f * x;
  r += 0.9f * (noise(x * 0.05f, y * 0.22f + 17, z * 0.22f) - 0.5f) +
       0.22f * (noise(x * 0.25f, y * 0.8f, z * 0.8f) - 0.5f);
  r += 0.5f * (noise(r * 0.45f, 3.1f, 50 * own) - 0.5f);  // years differ
  const float year = std::floor(r), t = r - year;
  const float strength = 0.55f + 0.45f * lattice(static_cast<int>(year), 11, 5);
  // late wood darkens slowly and ends at once
  const float late = strength * (smoothstep(0.25f, 0.88f, t) - smoothstep(0.93f, 1.0f, t));
  const float mean = 0.775f * 0.38f;  // of `late`
  const float rings = mix(late, mean, smoothstep(0.3f, 1.0f, seen));
  const float fine = 1 - smoothstep(0.04f, 0.25f, seen);
  const float fiber = (noise(x * 0.22f, y * 7, z * 7) - 0.5f) + 0.6f * (noise(x * 0.6f, y * 17, z * 17) - 0.5f);
  const float pore = smoothstep(0.80f, 0.90f, noise(x * 0.35f + 9, y * 9, z * 9)) * (1 - 0.6f * t);
  const float patch = 0.90f + 0.2f * noise(x * 0.03f + 5, y * 0.12f, z * 0.12f + 40 * own);
  Vec3f c = mix(look.color, look.color * late_wood, rings) * (patch * (1 + 0.22f * fine * fiber));
  c = mix(c, c * pore_wood, fine * pore);
  return min(max(c, Vec3f{}), Vec3f{1, 1, 1});
}

}  // namespace dreampm::trace
