// Particle shifting: liquids give way to waves of density two cells long. Nodes measure such a
// wave, but pressure pushes each node alike from both sides, and no velocity of nodes changes the
// wave; so particles are moved by positions, as in SPH (Lind et al. 2012) and in MPM's delta
// correction (Baumgarten and Kamrin 2023). Lengths in cells.
#pragma once
#include <type_traits>

#include "dreampm/physics/law.h"
#include "dreampm/physics/transfer.h"
#include "dreampm/physics/volume_correction.h"

namespace dreampm {

/// Share of a full node's content that a kernel reads at a place where the liquid lies at its rest
/// density, from the first moments and second differences of the reading: 1 inside, about 1/2 on a
/// flat surface. A surface shows by the slope of the reading and not by its level, so that liquid
/// that has swollen is not taken for a surface. `slope` = 4 |sum w m (x_i - x_p)| / sum w m;
/// `curvature` = -(sum of second differences) / sum w m. Denominator: 1 over the reading under a
/// flat surface of any tilt, fitted to half-spaces at random offsets (within 2 % in the mean).
/// Numerator: sheets, drops and edges have a curvature above the 0.57 of half-spaces; it falls to
/// 0, and nothing is known of their density.
template <class R>
DM_FN R reading_at_rest_density(const R& slope, const R& curvature) {
  using S = Scalar<R>;
  const R zero(S(0)), one(S(1));
  const R thin = max(curvature - R(S(0.6)), zero) * R(S(1 / 1.35));
  const R cubic = mul_add(mul_add(mul_add(slope, R(S(0.1485)), R(S(0.4097))), slope, R(S(0.2547))), slope, one);
  return max(one - thin * thin, zero) / cubic;
}

/// Laws of liquids with a pace of volume relaxation, `volume_relaxation()` [m/s]: its time is 300
/// dx/volume_relaxation(). Only steps that relax volume (state/volume_relaxation.h) measure their
/// density.
template <class M>
concept VolumeRelaxed =
    M::info.liquid && requires(const typename M::template Law<float>& law) { law.volume_relaxation(); };

/// The density of a liquid around a particle, and its unevenness.
template <class R>
struct DensityState {
  /// Displacement [cells] per unit strain: -t_a/2 times the second difference of the nodes' content
  /// along a beyond noise, over that of a full node, times `inside`: at surfaces second differences
  /// are those of the shape. What a wave of two cells has beyond noise so falls to 1/sqrt(e).
  Vec3<R> shift;
  R inside;        ///< 1 where the nodes around are full, 0 where they lack a tenth or more beside what full ones may
  R missing;       ///< content that the nodes at surfaces would have besides if they were full, weighed as that is
  R node_content;  ///< of the nodes, weighed
  /// `reading_at_rest_density` here [1]; beside colliders and solids times what is read there of
  /// the density.
  R at_rest;
};

/// Two numbers of a node, gathered at once.
template <class R>
struct Pair {
  R first, second;
  friend DM_FN Pair operator+(const Pair& a, const Pair& b) { return {a.first + b.first, a.second + b.second}; }
  friend DM_FN Pair operator-(const Pair& a, const Pair& b) { return {a.first - b.first, a.second - b.second}; }
  friend DM_FN Pair operator*(const Pair& a, const R& s) { return {a.first * s, a.second * s}; }
  friend DM_FN Pair mul_add(const Pair& a, const R& s, const Pair& b) {
    return {mul_add(a.first, s, b.first), mul_add(a.second, s, b.second)};
  }
  friend DM_FN Pair mul_sub(const Pair& a, const R& s, const Pair& b) {
    return {mul_sub(a.first, s, b.first), mul_sub(a.second, s, b.second)};
  }
};

/// A tag for places where only the liquid takes room.
struct NothingElse {};

/// `row(i, j)`: what the nodes hold, as in gather(), and `full` what a full one does; `t`: the
/// particle from its middle node. `taken(i, j)`: what others take of the nodes' kernels, in the
/// same form: the liquid does not lack that.
template <class R, int nx, int ny, class RowAt, class TakenAt = NothingElse>
DM_FN DensityState<R> density_state(const Shared<R, nx>& x, const Shared<R, ny>& y, const LinePlace<R>& z,
                                    const R (&t)[3], const R& full, const RowAt& row, const TakenAt& taken = {}) {
  using S = Scalar<R>;
  const R zero(S(0)), wanted = full * R(S(VolumeCorrection::full_enough)),
                      noise = full * R(S(VolumeCorrection::shift_noise));
  // Volume that others take counts as content.
  const auto held = [&](int i, int j, const LineSpline<R>& content) __attribute__((always_inline)) {
    NodeRow<R> nodes = nodes_of(content);
    if constexpr (!std::is_same_v<TakenAt, NothingElse>) {
      const NodeRow<R> others = nodes_of(taken(i, j));
      for (int k = 0; k < 3; ++k) nodes.n[k] = mul_add(others.n[k], full, nodes.n[k]);
    }
    return nodes;
  };
  R least = wanted;
  const Moments<R> content = gather<R, all_bends>(x, y, z, [&](int i, int j) __attribute__((always_inline)) {
    const LineSpline<R> line = row(i, j);
    const NodeRow<R> nodes = held(i, j, line);
    least = min(least, min(nodes.n[0], min(nodes.n[1], nodes.n[2])));
    return line;
  });
  Pair<R> short_of{zero, zero};
  // Within matter no node lacks anything.
  if (any(least < wanted))
    short_of = gather_value<Pair<R>>(x, y, z, [&](int i, int j) __attribute__((always_inline)) {
      const NodeRow<R> nodes = held(i, j, row(i, j));
      const auto each = [&](const R& n) __attribute__((always_inline)) {
        return Pair<R>{max(wanted - n, zero), select(n < wanted, full - n, zero)};
      };
      return line_spline<R>(each(nodes.n[0]), each(nodes.n[1]), each(nodes.n[2]));
    });
  const auto& [lack, missing] = short_of;
  const R inside = max(full - R(S(10)) * lack, zero) / full, scale = inside * R(S(-0.5)) / full;
  Vec3<R> shift;
  for (int a = 0; a < 3; ++a) {
    const R bend = content.bend[a];
    shift[a] = t[a] * (bend - min(max(bend, -noise), noise)) * scale;
  }
  // Beside colliders and solids the liquid is taken to go on as it lies here, with a density d +
  // g.(x - x_p), of which the nodes hold the part that is left free.
  Moments<R> all = content;
  R read(S(1));  // content/free, over d
  if constexpr (!std::is_same_v<TakenAt, NothingElse>) {
    const Moments<R> others = gather<R, all_bends>(x, y, z, taken);
    const R per_free = R(S(1)) / max(R(S(1)) - others.value, R(S(VolumeCorrection::least_open_fraction)));
    const auto find_slopes = [&](const R& density) __attribute__((always_inline)) {
      for (int a = 0; a < 3; ++a)
        all.first_moment[a] = mul_add(others.first_moment[a], density, content.first_moment[a]) * per_free;
    };
    const R density = content.value * per_free;
    find_slopes(density);
    R beyond = content.value;
    for (int a = 0; a < 3; ++a)
      beyond = mul_add(others.first_moment[a] * R(S(apic_inertia)), all.first_moment[a], beyond);
    all.value = min(max(beyond * per_free, R(S(0.5)) * density), R(S(2)) * density);
    find_slopes(all.value);
    for (int a = 0; a < 3; ++a) all.bend[a] = mul_add(others.bend[a], all.value, content.bend[a]) * per_free;
    read = density / max(all.value, R(S(1e-30)));
  }
  const Vec3<R> moment{all.first_moment[0], all.first_moment[1], all.first_moment[2]};
  const R per_content = R(S(1)) / max(all.value, R(S(1e-30)));
  const R at_rest = read * reading_at_rest_density<R>(R(S(apic_inertia)) * sqrt(fused_norm2(moment)) * per_content,
                                                      -(all.bend[0] + all.bend[1] + all.bend[2]) * per_content);
  return {shift, inside, missing, content.value, at_rest};
}

}  // namespace dreampm
