// The passes of a sub-cycled step on a device: the momentum that viscous stress gives, and the
// largest speed that particles gather. They change no particle.
#pragma once
#include "dreampm/backend/gpu/pass.h"

namespace dreampm::gpu {

/// Scatters the momentum of viscous stress in the whole step (viscous_slopes); for a stage of
/// viscosity.
template <class M>
struct ViscousPass {
  using Material = M;
  static constexpr int threads = 128;
  struct Shared {
    NodeCopy nodes;
    ArenaSums field;
    float speed[threads];
  };

  typename M::template Law<float> law;
  SetStep<float> step;
  ScatterBounds bounds;
  PassInput in;
  ArenaOutput out;
  float* speed;  ///< by block of particles: the largest scattered_speed
  int field;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    if (in.block_start[b] == in.block_start[b + 1]) {
      block.each_thread([&](int t) {
        write_zeros<threads>(t, b, out);
        if (t == 0 && out.first) speed[b] = 0;
      });
      return;
    }
    block.each_thread([&](int t) {
      copy_nodes<threads>(t, in.stencil_blocks + 8 * b, in.field, shared.nodes);
      clear<threads>(t, shared.field);
    });
    block.each_thread([&](int t) {
      float fastest = 0;
      const ScatterUnits units = field_units(in.loads[b], field, bounds);
      each_particle_apart<threads>(in.block_start, static_cast<std::uint32_t>(b), t, [&](std::uint32_t p) {
        const Stencil<float> s =
            make_stencil(Vec3<float>{in.particles.u[0][p], in.particles.u[1][p], in.particles.u[2][p]});
        const auto found = gather<Vec3<float>, no_bends>(s, velocity_rows(s, shared.nodes));
        typename M::template State<float> state;
        for (int k = 0; k < state_columns<M>; ++k) state[k] = in.particles.state[k][p];
        Vec3<float> slope[3];
        viscous_slopes<M, float>(law, step, state, found.first_moment, slope);
        fastest = max(scattered_speed({}, slope, step.mass), fastest);
        scatter_counts<Block, vector_part>(s, {}, slope, 0, units, shared.field);
      });
      shared.speed[t] = fastest;
    });
    block.each_thread([&](int t) {
      if (t == 0) {
        for (int i = 1; i < threads; ++i) shared.speed[0] = max(shared.speed[i], shared.speed[0]);
        speed[b] = max(shared.speed[0], out.first ? 0.0f : speed[b]);
      }
      write<threads>(t, b, shared.field, out);
    });
  }
};

/// The square of the largest speed that the particles of each block gather [m^2/s^2].
struct SpeedPass {
  static constexpr int threads = 128;
  struct Shared {
    NodeCopy nodes;
    float speed2[threads];
  };

  PassInput in;
  float* speed2;  ///< by block of particles
  bool first;     ///< else what is there counts too

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    block.each_thread([&](int t) { copy_nodes<threads>(t, in.stencil_blocks + 8 * b, in.field, shared.nodes); });
    block.each_thread([&](int t) {
      float most = 0;
      each_particle<threads>(in.block_start, static_cast<std::uint32_t>(b), t, [&](std::uint32_t p) {
        const Stencil<float> s =
            make_stencil(Vec3<float>{in.particles.u[0][p], in.particles.u[1][p], in.particles.u[2][p]});
        const Vec3<float> v = gather_value<Vec3<float>>(s, velocity_rows(s, shared.nodes));
        most = max(dot(v, v), most);
      });
      shared.speed2[t] = most;
    });
    block.each_thread([&](int t) {
      if (t != 0) return;
      float most = first ? 0.0f : speed2[b];
      for (int i = 0; i < threads; ++i) most = max(shared.speed2[i], most);
      speed2[b] = most;
    });
  }
};

}  // namespace dreampm::gpu
