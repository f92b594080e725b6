#include "dreampm/render/floor.h"

#include <array>

#include "dreampm/base/parallel.h"
#include "dreampm/render/color.h"
#include "dreampm/render/photons.h"

namespace dreampm::trace {
namespace {

const Vec3f light_tile{0.80f, 0.75f, 0.67f}, dark_tile{0.66f, 0.60f, 0.52f}, grout_color{0.45f, 0.42f, 0.38f};
constexpr std::size_t photon_parts = 4;  // fixed, so that sums do not depend on the threads

}  // namespace

FloorPattern::FloorPattern(const Box3f& basin, model::Place place)
    : scale_(std::max(basin.size().x, basin.size().z)),
      middle_x_(basin.center().x),
      middle_z_(basin.center().z),
      has_tiles_(place != model::Place::studio),
      shade_(place == model::Place::night ? 0.45f : 1) {
  tile_ = 0.11f * std::exp2(std::round(std::log2(scale_)));
  grout_ = tile_ * (0.005f / 0.11f);
  grain_ = 10 / tile_;
}

Vec3f FloorPattern::albedo(float x, float z, float footprint) const {
  if (!has_tiles_) return studio_paper;
  const float u = x / tile_, v = z / tile_, iu = std::floor(u), iv = std::floor(v);
  const int i = static_cast<int>(iu), j = static_cast<int>(iv);
  const float edge_u = std::min(u - iu, 1 - (u - iu)) * tile_, edge_v = std::min(v - iv, 1 - (v - iv)) * tile_;
  const float own = unit_float(hash32(static_cast<std::uint32_t>(i) * 1973u ^ static_cast<std::uint32_t>(j) * 9277u));
  Vec3f c = ((i + j) & 1) != 0 ? light_tile : dark_tile;
  c *= (0.94f + 0.12f * own) * (0.97f + 0.06f * value_noise(x * grain_, z * grain_));
  const float far = smoothstep(0.25f, 1.0f, footprint / tile_);
  c = mix(c, (light_tile + dark_tile) * 0.5f, far);
  const float soft = std::max(0.011f * tile_, 0.5f * footprint), half = 0.5f * grout_;
  const float on_tile =
      std::min(smoothstep(half - soft, half + soft, edge_u), smoothstep(half - soft, half + soft, edge_v));
  const float grout = mix(1 - on_tile, 1.4f * grout_ / tile_, far);
  return mix(c, grout_color, grout) * shade_;
}

float FloorPattern::fade(float x, float z) const {
  const float r = std::hypot(x - middle_x_, z - middle_z_) / (4.5f * scale_);
  return 1 - std::exp(-std::pow(r, 2.2f));
}

FloorLight::FloorLight(const Geometry& geometry, const Sky& sky, const Box3f& basin)
    : geometry_(geometry), sky_(sky), scale_(std::max(basin.size().x, basin.size().z)) {
  // a drop that flew far must not coarsen the grid
  const Vec3f near{scale_, scale_, scale_};
  const Box3f b{max(geometry.bounds().min, basin.min - near), min(geometry.bounds().max, basin.max + near)};
  const float margin = 0.45f * scale_;
  x0_ = b.min.x - margin, x1_ = b.max.x + margin, z0_ = b.min.z - margin, z1_ = b.max.z + margin;
  top_ = geometry.bounds().max.y;
  if (!sky.has_sun()) return;
  // the shadow's side reaches further, within reason
  const Vec3f s = sky.sun_direction();
  const float reach = 0.9f * (b.max.y - geometry.floor_y()) / s.y;
  const float dx = std::clamp(-s.x * reach, -4 * scale_, 4 * scale_),
              dz = std::clamp(-s.z * reach, -4 * scale_, 4 * scale_);
  (dx < 0 ? x0_ : x1_) += dx;
  (dz < 0 ? z0_ : z1_) += dz;
}

Vec3f FloorLight::irradiance(float x, float z, float ior) const {
  Vec3f share{1, 1, 1}, sky = sky_.open_irradiance();
  const float inside = std::min(std::min(x - x0_, x1_ - x), std::min(z - z0_, z1_ - z));
  if (inside > 0) {
    const float known = std::min(1.0f, 12 * inside / (x1_ - x0_));
    if (!sun_.values.empty()) share = mix(share, sun_.at((x - x0_) / sun_.cell, (z - z0_) / sun_.cell), known);
    if (!sky_grid_.values.empty())
      sky = mix(sky, sky_grid_.at((x - x0_) / sky_grid_.cell, (z - z0_) / sky_grid_.cell), known);
  }
  return share * sky_.sun_irradiance() * (sky_.has_sun() ? sky_.sun_direction().y / (ior * ior) : 0.0f) + sky;
}

void FloorLight::bake_sun(bool bend, int photons, std::uint64_t seed) {
  if (!sky_.has_sun()) return;
  const float width = x1_ - x0_, depth = z1_ - z0_;
  LightGrid g = LightGrid::covering(width, depth, std::max(0.003f * scale_, std::sqrt(width * depth / 2e6f)));
  const std::size_t cells = g.values.size();
  const float span_x = static_cast<float>(g.width) * g.cell, span_z = static_cast<float>(g.height) * g.cell;
  const float each = static_cast<float>(cells) / static_cast<float>(photons);
  std::array<std::vector<Vec3f>, photon_parts> parts;
  parallel_for(photon_parts, 1, [&](std::size_t part) {
    std::vector<Vec3f>& sum = parts[part];
    sum.assign(cells, {});
    const auto splat = [&](float x, float z, const Vec3f& e) {
      const float u = (x - x0_) / g.cell - 0.5f, v = (z - z0_) / g.cell - 0.5f;
      if (!(u >= 0 && v >= 0) || u >= static_cast<float>(g.width - 1) || v >= static_cast<float>(g.height - 1)) return;
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      const float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
      Vec3f* c = &sum[static_cast<std::size_t>(j) * static_cast<std::size_t>(g.width) + static_cast<std::size_t>(i)];
      c[0] += e * ((1 - fu) * (1 - fv)), c[1] += e * (fu * (1 - fv));
      c[g.width] += e * ((1 - fu) * fv), c[g.width + 1] += e * (fu * fv);
    };
    for (std::size_t k = part; k < static_cast<std::size_t>(photons); k += photon_parts) {
      // targets on a lattice of rank 1 (golden ratio)
      const float x = x0_ + (static_cast<float>(k) + 0.5f) / static_cast<float>(photons) * span_x;
      const float z = z0_ + unit_float(static_cast<std::uint32_t>(k) * 2654435769u) * span_z;
      Sampler random(stream_of(seed, 1, static_cast<std::uint32_t>(k)), 0);
      const float a = random.next(), b = random.next();
      const Vec3f to_sun = sky_.sample_sun(a, b);
      const Vec3f start =
          Vec3f{x, geometry_.floor_y(), z} + to_sun * ((top_ + 0.05f * scale_ - geometry_.floor_y()) / to_sun.y);
      if (!geometry_.meets_bounds(start, -to_sun)) continue;
      splat(x, z, Vec3f{-each, -each, -each});
      const float time = geometry_.moves() ? random.next() : 0.5f;
      follow_photon(geometry_, start, -to_sun, time, bend,
                    [&](const Hit& hit, const Vec3f& p, const Vec3f&, const Vec3f& w, bool) {
                      if (hit.kind == Kind::floor) splat(p.x, p.z, w * each);
                    });
    }
  });
  parallel_for(cells, 65536, [&](std::size_t i) {
    for (const auto& part : parts) g.values[i] += part[i];
  });
  g.blur(1.3f);
  for (Vec3f& c : g.values) c = max(Vec3f{}, Vec3f{1, 1, 1} + c);
  sun_ = std::move(g);
}

void FloorLight::bake_sky(const Gather& gather, int rays, std::uint64_t seed) {
  LightGrid g =
      LightGrid::covering(x1_ - x0_, z1_ - z0_, std::max(0.03f * scale_, std::sqrt((x1_ - x0_) * (z1_ - z0_) / 2e4f)));
  const std::size_t w = static_cast<std::size_t>(g.width);
  const Frame up({0, 1, 0});
  parallel_for(g.values.size(), 64, [&](std::size_t i) {
    Vec3f sum;
    for (int k = 0; k < rays; ++k) {
      Sampler random(stream_of(seed, 2, static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(k));
      const float a = random.next(), b = random.next(), dx = random.next(), dz = random.next();
      const Vec3f p{x0_ + (static_cast<float>(i % w) + dx) * g.cell, geometry_.floor_y() + 10 * geometry_.epsilon(),
                    z0_ + (static_cast<float>(i / w) + dz) * g.cell};
      const Vec3f d = cosine_direction(up, a, b);
      // only the difference from open ground is left to the lot
      if (geometry_.meets_bounds(p, d)) sum += gather(p, d, random) - sky_.radiance(d, false);
    }
    g.values[i] = max(Vec3f{}, sky_.open_irradiance() + sum * (pi / static_cast<float>(rays)));
  });
  g.blur(0.8f);
  sky_grid_ = std::move(g);
}

}  // namespace dreampm::trace
