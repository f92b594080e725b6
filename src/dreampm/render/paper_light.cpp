#include "dreampm/render/paper_light.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"

namespace dreampm::trace {
namespace {

/// Cells, in basins: of the empty sheet, whose light changes slowly, and near things.
constexpr float open_cell = 0.4f, near_cell = 0.015f;
/// Things change the light on the sheet that far around them, in basins.
constexpr float reach = 0.6f;
constexpr float most_cells = 2e4f;
constexpr float near_blur = 1.1f;  ///< cells
/// The mesh of the bend is of flat pieces, before the sheet by less than this, in basins.
constexpr float off_sheet = 1e-3f;

}  // namespace

PaperLight::PaperLight(const Backdrop& paper)
    : paper_(paper),
      front_(-6 * paper.scale()),
      open_(LightGrid::covering(paper.end() - front_, 2 * paper.wide(), open_cell * paper.scale())) {}

void PaperLight::bake_open(const Arriving& arriving, int rays, std::uint64_t seed) {
  LightGrid g = open_;
  const auto w = static_cast<std::size_t>(g.width);
  parallel_for(g.values.size(), 16, [&](std::size_t i) {
    Vec3f sum;
    for (int k = 0; k < rays; ++k) {
      Sampler random(stream_of(seed, 8, static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(k));
      const float a = random.next(), b = random.next();
      const Backdrop::Place place{front_ + (static_cast<float>(i % w) + a) * g.cell,
                                  (static_cast<float>(i / w) + b) * g.cell - paper_.wide()};
      const Vec3f n = paper_.normal_at(place);
      sum += arriving(paper_.point_at(place) + n * (off_sheet * paper_.scale()), n, random);
    }
    g.values[i] = sum * (1 / static_cast<float>(rays));
  });
  g.blur(0.7f);
  open_ = std::move(g);
}

void PaperLight::bake_near(const Box3f& box, const Arriving& arriving, const Arriving& open, const Lies& lies, int rays,
                           std::uint64_t seed) {
  const float margin = reach * paper_.scale(), wide = box.size().x + 2 * margin, deep = box.size().z + 2 * margin;
  const float cell = std::max(near_cell * paper_.scale(), std::sqrt(wide * deep / most_cells));
  std::array<Layer, 2> layers;
  for (Layer& layer : layers) layer = {LightGrid::covering(wide, deep, cell), LightGrid::covering(wide, deep, cell)};
  x0_ = box.min.x - margin, z0_ = box.min.z - margin;
  const float y = paper_.point_at({0, 0}).y;
  const auto w = static_cast<std::size_t>(layers[0].light.width);
  parallel_for(layers[0].light.values.size(), 64, [&](std::size_t i) {
    for (int k = 0; k < rays; ++k) {
      Sampler random(stream_of(seed, 9, static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(k));
      const float a = random.next(), b = random.next();
      const Vec3f p{x0_ + (static_cast<float>(i % w) + a) * cell, y, z0_ + (static_cast<float>(i / w) + b) * cell};
      const Over over = lies(p);
      if (over == Over::opaque) continue;
      Layer& layer = layers[over == Over::nothing ? 0 : 1];
      Sampler same = random;
      layer.light.values[i] += arriving(p, {0, 1, 0}, random) - open(p, {0, 1, 0}, same);
      layer.weight.values[i] += Vec3f{1, 1, 1};
    }
  });
  for (Layer& layer : layers) layer.light.blur(near_blur), layer.weight.blur(near_blur);
  near_ = std::move(layers);
}

Vec3f PaperLight::near_at(const Vec3f& p, bool in_air) const {
  if (near_[0].light.values.empty()) return {};
  const LightGrid& g = near_[0].light;
  const float u = (p.x - x0_) / g.cell, v = (p.z - z0_) / g.cell;
  const float inside =
      std::min(std::min(u, static_cast<float>(g.width) - u), std::min(v, static_cast<float>(g.height) - v));
  if (inside <= 0) return {};
  for (const bool other : {false, true}) {
    const Layer& layer = near_[in_air != other ? 0 : 1];
    const float weight = layer.weight.at(u, v).x;
    // It fades over the outermost sixth of the reach.
    if (weight > 1e-3f)
      return layer.light.at(u, v) * (std::min(1.0f, 6 * inside * g.cell / (reach * paper_.scale())) / weight);
  }
  return {};
}

Vec3f PaperLight::irradiance(const Vec3f& p, bool in_air) const {
  const Backdrop::Place at = paper_.place_of(p);
  const Vec3f open = open_.at((at.along - front_) / open_.cell, (at.across + paper_.wide()) / open_.cell);
  return max(Vec3f{}, at.along <= paper_.bend_begin() ? open + near_at(p, in_air) : open);
}

}  // namespace dreampm::trace
