#include "dreampm/surface/carry.h"

#include <algorithm>
#include <map>
#include <optional>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/cells.h"
#include "dreampm/surface/linear_fit.h"

namespace dreampm::surface {
namespace {

constexpr float reach_spacings = 2, fit_spacings = 3;

class Neighbors {
 public:
  Neighbors(const Carriers& particles, float spacings)
      : positions_(particles.positions), radius_(spacings * particles.spacing), cells_(particles.positions, radius_) {}
  float radius() const { return radius_; }

  /// Calls use(particle, offset from x, square of the distance over that of the reach) for all
  /// within the reach, in an order that depends on the particles alone.
  template <class Use>
  void within(const Vec3f& x, float reach, const Use& use) const {
    const float per_reach2 = 1 / (reach * reach);
    const Vec3f box{reach, reach, reach};
    for_cells(cells_, x - box, x + box, [&](std::size_t cell) {
      for (std::uint32_t i = cells_.first[cell]; i < cells_.first[cell + 1]; ++i) {
        const std::size_t p = cells_.order[i];
        const Vec3f d = positions_[p] - x;
        if (const float q2 = length2(d) * per_reach2; q2 < 1) use(p, d, q2);
      }
    });
  }
  /// Calls use(particle, weight) for those that count at x: all within the reach, else the nearest.
  template <class Use>
  void weighted(const Vec3f& x, const Use& use) const {
    bool any = false;
    within(x, radius_, [&](std::size_t p, const Vec3f&, float q2) {
      const float t = (1 - q2) * (1 - q2);
      use(p, t * t), any = true;
    });
    if (!any) use(nearest(x), 1.0f);
  }

 private:
  std::size_t nearest(const Vec3f& x) const {
    std::optional<std::size_t> found;
    for (float reach = 2 * radius_, best = 1; !found; reach *= 2, best = 1)
      within(x, reach, [&](std::size_t p, const Vec3f&, float q2) {
        if (q2 < best) best = q2, found = p;
      });
    return *found;
  }

  std::span<const Vec3f> positions_;
  float radius_;
  CellGrid cells_;
};

/// Calls of_vertex(neighbors, vertex) for each.
template <class T, class OfVertex>
std::vector<T> for_vertices(std::span<const Vec3f> vertices, const Carriers& particles, float spacings,
                            const OfVertex& of_vertex) {
  const Neighbors neighbors(particles, spacings);
  std::vector<T> out(vertices.size());
  parallel_for(out.size(), 512, [&](std::size_t v) { out[v] = of_vertex(neighbors, vertices[v]); });
  return out;
}

/// The different colors of particles, as pigments, and which of them each has.
struct Palette {
  Palette(std::span<const Vec3f> colors, Mixing mixing) {
    std::map<std::array<float, 3>, std::uint32_t> known;
    for (const Vec3f& c : colors) {
      const auto [place, fresh] = known.try_emplace({c.x, c.y, c.z}, static_cast<std::uint32_t>(pigments.size()));
      if (fresh) pigments.push_back(Pigment::of(c, mixing));
      of_particle.push_back(place->second);
    }
  }
  std::vector<Pigment> pigments;
  std::vector<std::uint32_t> of_particle;
};

}  // namespace

std::vector<float> carry_numbers(std::span<const Vec3f> vertices, const Carriers& particles,
                                 std::span<const float> values) {
  return for_vertices<float>(vertices, particles, reach_spacings, [&](const Neighbors& near, const Vec3f& x) {
    float sum = 0, weight = 0;
    near.weighted(x, [&](std::size_t p, float w) { sum += w * values[p], weight += w; });
    return sum / weight;
  });
}

std::vector<float> carry_names(std::span<const Vec3f> vertices, const Carriers& particles,
                               std::span<const float> values) {
  return for_vertices<float>(vertices, particles, reach_spacings, [&](const Neighbors& near, const Vec3f& x) {
    std::vector<std::pair<float, float>> weights;  // few names meet at a vertex
    near.weighted(x, [&](std::size_t p, float w) {
      const auto of = std::find_if(weights.begin(), weights.end(), [&](const auto& n) { return n.first == values[p]; });
      if (of == weights.end())
        weights.emplace_back(values[p], w);
      else
        of->second += w;
    });
    return std::max_element(weights.begin(), weights.end(),
                            [](const auto& a, const auto& b) {
                              return a.second != b.second ? a.second < b.second : a.first > b.first;
                            })
        ->first;
  });
}

std::vector<Vec3f> carry_colors(std::span<const Vec3f> vertices, const Carriers& particles,
                                std::span<const Vec3f> colors, Mixing mixing) {
  const Palette palette(colors, mixing);
  return for_vertices<Vec3f>(vertices, particles, reach_spacings, [&](const Neighbors& near, const Vec3f& x) {
    PigmentMix mix(mixing);
    std::optional<std::size_t> first;
    bool several = false;
    near.weighted(x, [&](std::size_t p, float w) {
      if (!first) first = p;
      several |= palette.of_particle[p] != palette.of_particle[*first];
      mix.add(palette.pigments[palette.of_particle[p]], w);
    });
    return several ? mix.color() : colors[*first];  // one color is what it was, to the last bit
  });
}

std::vector<Vec3f> carry_vorticity(std::span<const Vec3f> vertices, const Carriers& particles,
                                   std::span<const Vec3f> velocities) {
  return for_vertices<Vec3f>(vertices, particles, fit_spacings, [&](const Neighbors& near, const Vec3f& x) {
    LinearFit fit(near.radius());
    near.within(x, near.radius(), [&](std::size_t p, const Vec3f& d, float) { fit.add(d, velocities[p]); });
    if (fit.empty()) return Vec3f{};
    const Mat3f g = fit.slope();
    return Vec3f{g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1)};
  });
}

}  // namespace dreampm::surface
