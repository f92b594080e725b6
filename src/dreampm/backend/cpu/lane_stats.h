// Statistics that a kernel gathers over its particles, lane by lane.
#pragma once
#include "dreampm/backend/cpu/gather.h"

namespace dreampm::DM_ISA {
namespace {

/// An Extent lane by lane.
class LaneExtent {
 public:
  /// Positions; numbers that are none count for nothing.
  DM_FN void add(const Vec3<F>& u) {
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) low_[a] = min(u[a], low_[a]), high_[a] = max(u[a], high_[a]);
  }
  DM_FN void add_to(Extent& extent) const {
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      extent.low[a] = dreampm::min(smallest_of(low_[a]), extent.low[a]);
      extent.high[a] = dreampm::max(largest_of(high_[a]), extent.high[a]);
    }
  }

 private:
  Vec3<F> low_{F(1e9f), F(1e9f), F(1e9f)}, high_{F(-1e9f), F(-1e9f), F(-1e9f)};
};

/// PassStats and the Extent lane by lane. Sums of one block's few hundred particles lose nothing
/// that a ledger would see.
class LaneStats {
 public:
  /// `n`: lanes that are in use; the others repeat one of them.
  template <class M>
  DM_FN void add(const SetStep<float>& step, const BlockWalls<float>& walls, int n, const G2PResult<F>& g,
                 const P2GTerms<F>& s, const F& j, const StressResponse<F>& response, const Vec3<F>& u,
                 LaneMask pushed) {
    wave_speed_ = max(response.sound_speed, wave_speed_);
    viscosity_ = max(response.kinematic_viscosity, viscosity_);
    j_min_ = min(j, j_min_);
    j_max_ = max(j, j_max_);
    if (walls.near) pushed_ += select(pushed && first_lanes(n), F(1.0f), F(0.0f));
    count(n,
          {kinetic_energy(g, s, step), response.dissipation.viscous, response.dissipation.plastic,
           response.dissipation.relaxed},
          energy_);
    bool shifts = walls.colliders;
    if constexpr (VolumeRelaxed<M>) {
      const bool measured = measures<M>(step.volume_relaxation);
      shifts = shifts || measured;
      if (measured) count(n, {s.swollen}, swollen_);
    }
    if (shifts) {
      const Vec3<F> turned = cross(s.shifted, s.own_velocity);
      count(n, {s.shifted.x, s.shifted.y, s.shifted.z}, shifted_);
      count(n, {turned.x, turned.y, turned.z}, turned_);
    }
    extent_.add(u);
    const F all = u.x + u.y + u.z + j + response.sound_speed;
    none_ = mul_add(all, F(0.0f), none_);  // 0 if finite, NaN if not
  }
  DM_FN bool finite() const { return !any(!(none_ == F(0.0f))); }

  DM_FN void add_to(const BlockPass& pass, PassStats& stats, BlockExtent& there) const {
    const auto raise = [](double& to, float found) DM_INLINED { to = dreampm::max(static_cast<double>(found), to); };
    raise(stats.wave_speed, largest_of(wave_speed_));
    raise(stats.viscosity, largest_of(viscosity_));
    raise(stats.j_max, largest_of(j_max_));
    stats.j_min = dreampm::min(static_cast<double>(smallest_of(j_min_)), stats.j_min);
    stats.pushed += static_cast<std::uint32_t>(sum_of(pushed_));
    const double mass = static_cast<double>(pass.step.mass), volume = static_cast<double>(pass.step.volume);
    const auto energy = [&](int i) DM_INLINED { return static_cast<double>(sum_of(energy_[i])); };
    stats.energy.kinetic += energy(0) * mass;
    if (pass.velocity_old_out) stats.energy.kept_kinetic += energy(0) * mass;
    stats.energy.viscous += energy(1) * volume;
    stats.energy.plastic += energy(2) * volume;
    stats.energy.relaxed += energy(3) * volume;
    stats.swollen += static_cast<double>(sum_of(swollen_[0])) * volume;
    if (pass.step.volume_relaxation > 0 || pass.walls.colliders)
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const double scale = mass * static_cast<double>(pass.step.dx);
        stats.shifted[a] += scale * static_cast<double>(sum_of(shifted_[a]));
        stats.turned[a] += scale * static_cast<double>(sum_of(turned_[a]));
      }
    stats.finite = stats.finite && finite();
    extent_.add_to(there.extent);
  }

 private:
  template <int numbers>
  static DM_FN void count(int n, const F (&of)[numbers], F (&sums)[numbers]) {
    if (n == W)
#pragma GCC unroll 4
      for (int i = 0; i < numbers; ++i) sums[i] += of[i];
    else
#pragma GCC unroll 4
      for (int i = 0; i < numbers; ++i) sums[i] += select(first_lanes(n), of[i], F(0.0f));
  }

  // One initial value for each, and loops above that are unrolled: one over an array would keep all
  // of this in memory.
  LaneExtent extent_;
  F wave_speed_, viscosity_, j_min_{1e30f}, j_max_{-1e30f}, pushed_, none_;
  F energy_[4]{F(), F(), F(), F()}, shifted_[3]{F(), F(), F()}, turned_[3]{F(), F(), F()}, swollen_[1]{F()};
};

}  // namespace
}  // namespace dreampm::DM_ISA
