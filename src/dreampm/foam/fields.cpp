#include "dreampm/foam/fields.h"

namespace dreampm::foam {
namespace {

/// Below this share of space there is nothing to take a velocity from.
constexpr float least_fill = 0.02f;

/// At half a cell from a wall the velocities of matter and image go with their ways by 0.4.
constexpr float parting = 2.5f;

/// The share of a node's cell that obstacles take.
float blocked_at(std::span<const Obstacle> obstacles, const Vec3f& p, float cell) {
  float share = 0;
  for (const Obstacle& o : obstacles)
    share = std::max(share, std::clamp(0.5f - o.distance(p, cell) / cell, 0.0f, 1.0f));
  return share;
}

float per_cell(const NodeAxes& axes) { return axes[0].per_cell * axes[1].per_cell * axes[2].per_cell; }

}  // namespace

MotionField::MotionField(const FoamMatter& matter, std::span<const Obstacle> obstacles, const FoamRules& rules)
    : field_(node_axes(rules.room, rules.cell)), cell_(rules.cell) {
  const float share = per_cell(field_.axes());
  field_.scatter(matter.position, [&](std::uint32_t i, const Vec3f& sign, const Vec3f&, std::array<float, 5>& to) {
    const float m = volume_of(matter, i, rules.spacing) * share;
    const Vec3f v = matter.velocity[i] * sign;
    to = {m, m * v.x, m * v.y, m * v.z, 0};
  });
  parallel_for(field_.bricks(), 8, [&](std::size_t b) {
    auto& brick = field_.brick(b);
    for (std::size_t n = 0; n < 64; ++n) {
      const float m = brick[0][n];
      if (!(m > 0)) continue;
      for (std::size_t k = 1; k < 4; ++k) brick[k][n] /= m;
      if (!obstacles.empty())
        brick[4][n] = blocked_at(obstacles, field_.place(field_.node(b, static_cast<int>(n))), cell_);
    }
  });
}

float MotionField::fill(const Vec3f& p) const {
  float sum = 0;
  field_.about(p, [&](const auto& b, int at, const Vec3f&, float w) {
    const auto n = static_cast<std::size_t>(at);
    sum += w * std::min(1.0f, b[0][n] + b[4][n]);
  });
  return sum;
}

float MotionField::fill(const Vec3f& p, Vec3f& gradient) const {
  float sum = 0;
  gradient = {};
  field_.about_with_slope(p, [&](const auto& b, int at, const Vec3f&, float w, const Vec3f& slope) {
    const auto n = static_cast<std::size_t>(at);
    const float share = std::min(1.0f, b[0][n] + b[4][n]);
    sum += w * share, gradient += slope * share;
  });
  return sum;
}

Vec3f MotionField::velocity(const Vec3f& p, float& share) const {
  Vec3f sum;
  share = 0;
  field_.about(p, [&](const auto& b, int at, const Vec3f& sign, float w) {
    const auto n = static_cast<std::size_t>(at);
    const float m = w * b[0][n];
    share += m, sum += Vec3f{b[1][n], b[2][n], b[3][n]} * sign * m;
  });
  return share > 0 ? sum / share : Vec3f{};
}

WayField::WayField(const FoamMatter& matter, std::span<const Vec3f> way, std::span<const std::uint8_t> known,
                   const FoamRules& rules)
    : field_(node_axes(rules.room, rules.cell)) {
  const float share = per_cell(field_.axes());
  field_.scatter(matter.position, [&](std::uint32_t i, const Vec3f& sign, const Vec3f&, std::array<float, 4>& to) {
    const float m = known[i] ? volume_of(matter, i, rules.spacing) * share : 0;
    const Vec3f d = way[i] * sign;
    to = {m, m * d.x, m * d.y, m * d.z};
  });
}

bool WayField::at(const Vec3f& p, Vec3f& way) const {
  Vec3f sum;
  float share = 0;
  field_.about(p, [&](const auto& b, int at, const Vec3f& sign, float w) {
    const auto n = static_cast<std::size_t>(at);
    share += w * b[0][n], sum += Vec3f{b[1][n], b[2][n], b[3][n]} * sign * w;
  });
  if (share < least_fill) return false;
  way = sum / share;
  return true;
}

// Sums of m, m v, m v^2, m v.r, m r and m r^2 at each node, with the way r from node to particle.
Measures::Measures(const FoamMatter& matter, std::span<const Obstacle> obstacles, const FoamRules& rules)
    : field_(node_axes(rules.room, rules.scale)), scale_(rules.scale) {
  const float share = per_cell(field_.axes());
  field_.scatter(
      matter.position, [&](std::uint32_t i, const Vec3f& sign, const Vec3f& r, std::array<float, count>& to) {
        const float m = volume_of(matter, i, rules.spacing) * share;
        const Vec3f v = matter.velocity[i] * sign;
        to = {m, m * v.x, m * v.y, m * v.z, m * dot(v, v), m * dot(v, r), m * r.x, m * r.y, m * r.z, m * dot(r, r), 0};
      });
  average();
  meet(obstacles);
  differentiate();
  bend_surfaces();
}

/// Means, and how matter meets: of two particles |v| - v.x/|x| (Ihmsen 2012, eq. 2), with v and x
/// their differences; here by the moments of all that a node sees. The way apart counts `parting`
/// times, so that matter that parts along one axis, as from a wall, traps nothing.
void Measures::average() {
  parallel_for(field_.bricks(), 8, [&](std::size_t b) {
    auto& c = field_.brick(b);
    for (std::size_t n = 0; n < 64; ++n) {
      const float m = c[fill][n], v2 = c[4][n], vr = c[5][n], r2 = c[9][n];
      const Vec3f mr{c[6][n], c[7][n], c[8][n]};
      for (std::size_t k = 4; k < count; ++k) c[k][n] = 0;
      if (!(m > 0)) continue;
      const Vec3f v = Vec3f{c[vx][n], c[vy][n], c[vz][n]} / m, r = mr / m;
      c[vx][n] = v.x, c[vy][n] = v.y, c[vz][n] = v.z;
      const float spread = std::sqrt(std::max(0.0f, v2 / m - dot(v, v)));
      const float reach = std::sqrt(std::max(0.0f, r2 / m - dot(r, r)));
      // From a part of a cell on: less is a drop, which meets nothing.
      if (reach > 0.1f * scale_ && m > 0.05f)
        c[meeting][n] = std::sqrt(2.0f) * std::max(0.0f, spread - parting * (vr / m - dot(v, r)) / reach);
      c[taken][n] = m;
    }
  });
}

/// Obstacles take space, and matter that comes at them meets them as its image would.
void Measures::meet(std::span<const Obstacle> obstacles) {
  if (obstacles.empty()) return;
  parallel_for(field_.bricks(), 8, [&](std::size_t b) {
    auto& c = field_.brick(b);
    for (std::size_t n = 0; n < 64; ++n) {
      if (!(c[fill][n] > 0)) continue;
      const Vec3f p = field_.place(field_.node(b, static_cast<int>(n)));
      for (const Obstacle& o : obstacles) {
        const float d = o.distance(p, scale_), share = std::clamp(0.5f - d / scale_, 0.0f, 1.0f);
        c[taken][n] = std::min(1.0f, std::max(c[taken][n], c[fill][n] + share));
        if (d > scale_ || c[fill][n] < 0.05f) continue;
        const Vec3f v{c[vx][n], c[vy][n], c[vz][n]};
        const float towards = std::max(0.0f, -dot(v - o.velocity(p), o.normal(p)));
        c[meeting][n] = std::max(c[meeting][n], image_factor * towards * std::clamp(1 - d / scale_, 0.0f, 1.0f));
      }
    }
  });
}

/// Gradient of the space that is taken, and vorticity, by differences of the nodes beside.
void Measures::differentiate() {
  parallel_for(field_.bricks(), 4, [&](std::size_t b) {
    auto& c = field_.brick(b);
    for (std::size_t n = 0; n < 64; ++n) {
      if (!(c[fill][n] > 0)) continue;
      const Vec3i node = field_.node(b, static_cast<int>(n));
      Vec3f along[3];  // d v / d x_a
      for (int a = 0; a < 3; ++a) {
        float taken_at[2] = {0, 0};
        Vec3f v[2] = {{c[vx][n], c[vy][n], c[vz][n]}, {c[vx][n], c[vy][n], c[vz][n]}};
        for (int side = 0; side < 2; ++side) {
          Vec3i next = node;
          next[a] += 2 * side - 1;
          field_.at(next, [&](const auto& other, int at, const Vec3f& sign) {
            const auto m = static_cast<std::size_t>(at);
            taken_at[side] = std::min(1.0f, other[taken][m]);
            if (other[fill][m] > 0.1f) v[side] = Vec3f{other[vx][m], other[vy][m], other[vz][m]} * sign;
          });
        }
        c[gx + static_cast<std::size_t>(a)][n] = (taken_at[1] - taken_at[0]) / (2 * scale_);
        along[a] = (v[1] - v[0]) / (2 * scale_);
      }
      const Vec3f curl{along[1].z - along[2].y, along[2].x - along[0].z, along[0].y - along[1].x};
      c[whirl][n] = length(curl) * scale_;
    }
  });
}

/// The divergence of the outward normal.
void Measures::bend_surfaces() {
  const auto normal = [](const auto& c, std::size_t n) {
    const Vec3f g{c[gx][n], c[gy][n], c[gz][n]};
    return -normalized(g);
  };
  parallel_for(field_.bricks(), 4, [&](std::size_t b) {
    auto& c = field_.brick(b);
    for (std::size_t n = 0; n < 64; ++n) {
      if (!(c[fill][n] > 0) || length(Vec3f{c[gx][n], c[gy][n], c[gz][n]}) * scale_ < 0.15f) continue;
      const Vec3i node = field_.node(b, static_cast<int>(n));
      float sum = 0;
      for (int a = 0; a < 3; ++a)
        for (int side = 0; side < 2; ++side) {
          Vec3i next = node;
          next[a] += 2 * side - 1;
          float value = normal(c, n)[a];
          field_.at(next, [&](const auto& other, int at, const Vec3f& sign) {
            const auto m = static_cast<std::size_t>(at);
            if (other[fill][m] > 0) value = normal(other, m)[a] * sign[a];
          });
          sum += (2 * static_cast<float>(side) - 1) * value;
        }
      c[bend][n] = std::max(0.0f, sum / (2 * scale_));
    }
  });
}

Measures::At Measures::at(const Vec3f& p) const {
  At out;
  float space = 0;
  Vec3f g;
  field_.about(p, [&](const auto& c, int at, const Vec3f& sign, float w) {
    const auto n = static_cast<std::size_t>(at);
    const float m = w * c[fill][n];
    out.fill += m;
    space += w * std::min(1.0f, c[taken][n]);
    out.trapped_air += m * c[meeting][n], out.curvature += m * c[bend][n], out.vorticity += m * c[whirl][n];
    g += Vec3f{c[gx][n], c[gy][n], c[gz][n]} * sign * w;
  });
  if (!(out.fill > 0)) return out;
  out.trapped_air /= out.fill, out.curvature /= out.fill, out.vorticity /= out.fill;
  // Loose matter reads a few parts in a hundred below 1 inside.
  out.near_surface = std::clamp((0.97f - space) / 0.12f, 0.0f, 1.0f);
  out.outward = -normalized(g);
  return out;
}

}  // namespace dreampm::foam
