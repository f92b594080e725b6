// Lanes give what plain floats give, to a few units in the last place, for every instruction set
// that this machine has.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <vector>

#include "dreampm/math/explog.h"
#include "dreampm/math/svd3.h"
#include "lanes_under_test.h"
#include "states.h"

namespace dreampm {
namespace {
using namespace test;

struct Isa {
  const char* name;
  LanesUnderTest lanes;
};

std::vector<Isa> instruction_sets() {
  std::vector<Isa> all;
#if defined(__x86_64__)
  all.push_back({"sse4", sse4::lanes_under_test()});
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
    all.push_back({"avx2", avx2::lanes_under_test()});
#ifdef DM_LANE_PAIRS
    all.push_back({"pairs", pairs::lanes_under_test()});
#endif
  } else {
    std::printf("this machine has no AVX2: not tested\n");
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd"))
    all.push_back({"avx512", avx512::lanes_under_test()});
  else
    std::printf("this machine has no AVX-512: not tested\n");
#else
  all.push_back({"neon", neon::lanes_under_test()});
#endif
  return all;
}

constexpr double ulp = std::numeric_limits<float>::epsilon(), most_ulps = 16;

constexpr double wide(float x) { return static_cast<double>(x); }

/// The largest difference so far, in units in the last place of a scale.
struct Worst {
  double ulps = 0;
  void see(float a, float b, double scale) {
    const double d = std::abs(wide(a) - wide(b)) / (scale * ulp);
    if (d > ulps || std::isnan(d)) ulps = d;  // NaN stays
  }
};

/// Returns the change of an answer over an ulp where each number of the state changes by an ulp, in
/// all.
template <class M>
double felt(const Values& v, typename M::template State<float> state, const StrainIncrement<float>& at,
            double StressResponse<double>::* answer) {
  const auto law = M::template Law<double>::from(v);
  const StrainIncrement<double> there{static_cast<Mat3d>(at.gradient), wide(at.dt),     wide(at.volume),
                                      wide(at.volume_relaxation),      wide(at.strain), wide(at.inside),
                                      wide(at.surface_filled),         wide(at.at_rest)};
  const auto with = [&](int column, double change) {
    typename M::template State<double> s;
    for (int c = 0; c < state_columns<M>; ++c) s[c] = wide(state[c]);
    s[column] += change * std::max(1.0, std::abs(s[column]));
    return advanced(law, s, there).*answer;
  };
  double sum = 0;
  for (int c = 0; c < state_columns<M>; ++c) {
    const double same = with(c, 0);
    sum += std::max(std::abs(with(c, ulp) - same), std::abs(with(c, -ulp) - same));
  }
  return sum / ulp;
}

/// How far lanes are from plain floats over `rounds` random states of many particles each.
struct LawUlps {
  Worst state, stress, energy, sound, viscosity, implicit;
};
template <class M>
void compare_law(int index, const Isa& isa, const Values& v, int rounds, LawUlps& worst) {
  const auto law = M::template Law<float>::from(v);
  Rng rng(11);
  auto call = std::make_unique<LawCall>();
  for (int round = 0; round < rounds; ++round) {
    call->law = &law;
    call->dt = 1e-4f;
    call->volume_relaxation = 1e-4f;
    call->strain = 1e-3f;
    std::vector<typename M::template State<float>> states;
    for (int p = 0; p < lanes_tested; ++p) {
      states.push_back(random_state<M, float>(law, rng, 0.05));
      for (int c = 0; c < state_columns<M>; ++c) call->state[c][p] = states.back()[c];
      const Mat3d g = random_matrix(rng, 0.05);
      for (int k = 0; k < 9; ++k) call->gradient[k][p] = static_cast<float>(g.m[k]);
      call->volume[p] = static_cast<float>(between(rng, 0.8, 1.2));
      call->inside[p] = static_cast<float>(between(rng, 0, 1));
      call->surface_filled[p] = static_cast<float>(between(rng, 0.5, 1));
      call->at_rest[p] = static_cast<float>(between(rng, 0.5, 1));
    }
    isa.lanes.advance(index, *call);
    for (int p = 0; p < lanes_tested; ++p) {
      auto& s = states[static_cast<std::size_t>(p)];
      StrainIncrement<float> at{{},           call->dt,        call->volume[p],         call->volume_relaxation,
                                call->strain, call->inside[p], call->surface_filled[p], call->at_rest[p]};
      for (int k = 0; k < 9; ++k) at.gradient.m[k] = call->gradient[k][p];
      const auto before = s;
      const auto r = advanced(law, s, at);
      for (int c = 0; c < state_columns<M>; ++c)
        worst.state.see(call->state[c][p], s[c], std::max(1.0, static_cast<double>(std::abs(s[c]))));
      // Stress is a difference of numbers of the size of the stiffness, and of a viscosity times a
      // rate.
      const float tau[6] = {r.tau.xx, r.tau.yy, r.tau.zz, r.tau.xy, r.tau.xz, r.tau.yz};
      const double stiff = v["density"] * static_cast<double>(r.sound_speed) * static_cast<double>(r.sound_speed);
      double scale = stiff;
      for (const float x : tau) scale = std::max(scale, static_cast<double>(std::abs(x)));
      for (int k = 0; k < 6; ++k) worst.stress.see(call->tau[k][p], tau[k], scale);
      // Ill-conditioned answers may err by the effect of rounding of the state.
      const auto see = [&](Worst& so_far, float a, float b, double size, double StressResponse<double>::* answer) {
        if (std::abs(wide(a) - wide(b)) > most_ulps * ulp * size) size += felt<M>(v, before, at, answer);
        so_far.see(a, b, std::max(size, 1e-30));
      };
      see(worst.energy, call->energy[p], r.energy, std::max(stiff, wide(r.energy)), &StressResponse<double>::energy);
      see(worst.sound, call->sound[p], r.sound_speed, wide(r.sound_speed), &StressResponse<double>::sound_speed);
      see(worst.viscosity, call->viscosity[p], r.kinematic_viscosity, wide(r.kinematic_viscosity),
          &StressResponse<double>::kinematic_viscosity);
      // G dt/rho times a ratio less 1: where nothing holds on, the 1 is what errs.
      const double elastic = v.has("shear_modulus") ? v["shear_modulus"] * wide(call->dt) / v["density"] : 0;
      see(worst.implicit, call->implicit[p], r.implicit_viscosity, wide(r.implicit_viscosity) + elastic,
          &StressResponse<double>::implicit_viscosity);
    }
  }
}

void expect_near(const LawUlps& worst, const Values& v) {
  // Stress follows exp(-xi Jp) where there is hardening: xi ulp for each one of Jp.
  const double amplified = 1 + (v.has("hardening") ? v["hardening"] : 0);
  // The flow as rate^n is found by its logarithm over n; beyond e^16 one ulp of that is 16 of its
  // own.
  const double n = v.has("flow_index") ? v["flow_index"] : 1, logarithm = n == 1 ? 1 : 2 / std::min(n, 1.0);
  EXPECT_LE(worst.state.ulps, most_ulps) << text_of(v);
  EXPECT_LE(worst.stress.ulps, 2 * most_ulps * amplified) << text_of(v);
  EXPECT_LE(worst.energy.ulps, most_ulps) << text_of(v);
  EXPECT_LE(worst.sound.ulps, most_ulps) << text_of(v);
  EXPECT_LE(worst.viscosity.ulps, most_ulps) << text_of(v);
  EXPECT_LE(worst.implicit.ulps, most_ulps * logarithm) << text_of(v);
}

template <class M>
void check_law(int index, const Isa& isa, const Values& v) {
  LawUlps worst;
  compare_law<M>(index, isa, v, 10, worst);
  const auto& [state, stress, energy, sound, viscosity, implicit] = worst;
  std::printf(
      "%-10s on %-6s: state %.1f, stress %.1f, energy %.1f, wave speed %.1f, viscosity %.1f, implicit one %.1f ulp\n",
      std::string(M::info.name).c_str(), isa.name, state.ulps, stress.ulps, energy.ulps, sound.ulps, viscosity.ulps,
      implicit.ulps);
  expect_near(worst, v);
}

TEST(Lanes, EveryLawAsInPlainFloats) {
  for (const Isa& isa : instruction_sets()) {
    int index = 0;
    Materials::for_each([&]<class M>() {
      SCOPED_TRACE(std::string(M::info.name) + " on " + isa.name);
      check_law<M>(index, isa, complete(M::info));
      for (const Preset& preset : M::info.presets) {
        Values v;
        for (const Preset::Value& value : preset.values) v.set(value.key, value.value);
        check_law<M>(index, isa, complete(M::info, v));
      }
      ++index;
    });
  }
}

TEST(Lanes, EveryLawOverTheWholeRangeOfItsParameters) {
  for (const Isa& isa : instruction_sets()) {
    int index = 0;
    Materials::for_each([&]<class M>() {
      SCOPED_TRACE(std::string(M::info.name) + " on " + isa.name);
      Rng rng(16);
      for (const Values& v : kinds(M::info, 200, rng)) {
        LawUlps worst;
        compare_law<M>(index, isa, v, 1, worst);
        expect_near(worst, v);
      }
      ++index;
    });
  }
}

/// One particle in eleven is wild: turned inside out or torn, so that a law takes a way of its own
/// for it.
template <class M>
void check_neighbors(int index, const Isa& isa, const Values& v) {
  const auto law = M::template Law<float>::from(v);
  Rng rng(15);
  const auto call = std::make_unique<LawCall>(), alone = std::make_unique<LawCall>();
  call->law = &law;
  call->dt = 1e-4f;
  call->volume_relaxation = 1e-4f;
  call->strain = 1e-3f;
  for (int p = 0; p < lanes_tested; ++p) {
    auto s = random_state<M, float>(law, rng, 0.05);
    for (int c = 0; c < state_columns<M>; ++c) call->state[c][p] = s[c];
    const Mat3d g = random_matrix(rng, p % 11 == 0 ? 2.5 : 0.05);
    for (int k = 0; k < 9; ++k) call->gradient[k][p] = static_cast<float>(g.m[k]);
    call->volume[p] = static_cast<float>(between(rng, 0.8, 1.2));
    call->inside[p] = static_cast<float>(between(rng, 0, 1));
    call->surface_filled[p] = static_cast<float>(between(rng, 0.5, 1));
    call->at_rest[p] = static_cast<float>(between(rng, 0.5, 1));
  }
  const auto given = std::make_unique<LawCall>(*call);
  isa.lanes.advance(index, *call);
  for (int p = 0; p < lanes_tested; p += 5) {
    // The same particle in every lane.
    *alone = *given;
    const auto spread = [&](float(&column)[lanes_tested]) {
      std::fill(std::begin(column), std::end(column), column[p]);
    };
    for (int c = 0; c < state_columns<M>; ++c) spread(alone->state[c]);
    for (auto& column : alone->gradient) spread(column);
    spread(alone->volume), spread(alone->inside), spread(alone->surface_filled), spread(alone->at_rest);
    isa.lanes.advance(index, *alone);
    for (int c = 0; c < state_columns<M>; ++c) EXPECT_EQ(call->state[c][p], alone->state[c][0]) << p << " " << c;
    for (int k = 0; k < 6; ++k) EXPECT_EQ(call->tau[k][p], alone->tau[k][0]) << p << " " << k;
    EXPECT_EQ(call->energy[p], alone->energy[0]) << p;
    EXPECT_EQ(call->sound[p], alone->sound[0]) << p;
    EXPECT_EQ(call->viscosity[p], alone->viscosity[0]) << p;
    EXPECT_EQ(call->implicit[p], alone->implicit[0]) << p;
  }
}

TEST(Lanes, NoParticleFeelsItsNeighbors) {
  for (const Isa& isa : instruction_sets()) {
    int index = 0;
    Materials::for_each([&]<class M>() {
      SCOPED_TRACE(std::string(M::info.name) + " on " + isa.name);
      Rng rng(19);
      for (const Values& v : kinds(M::info, 60, rng)) check_neighbors<M>(index, isa, v);
      ++index;
    });
  }
}

TEST(Lanes, AClampOfStretchesNeverRaisesTheStoredEnergy) {
  for (const Isa& isa : instruction_sets()) {
    int index = -1;
    Materials::for_each([&]<class M>() {
      ++index;
      if constexpr (clamps<M>()) {
        SCOPED_TRACE(std::string(M::info.name) + " on " + isa.name);
        Rng rng(24);
        const auto call = std::make_unique<LawCall>();
        for (int draw = 0; draw < 200; ++draw) {
          const Values v = any_clamping(M::info, rng);
          const auto law = M::template Law<float>::from(v);
          const auto exact = M::template Law<double>::from(v);
          *call = LawCall{};
          call->law = &law;
          call->dt = 1e-4f;
          std::vector<StressResponse<double>> before;
          auto s = rest_state<M, double>();
          for (int p = 0; p < lanes_tested; ++p) {
            const Mat3d f = any_stretched(rng);
            for (int k = 0; k < 9; ++k) s.f.m[k] = static_cast<double>(call->state[k][p] = static_cast<float>(f.m[k]));
            call->state[9][p] = static_cast<float>(s.jp);
            before.push_back(exact.respond(s));
          }
          isa.lanes.advance(index, *call);
          for (int p = 0; p < lanes_tested; ++p) {
            const StressResponse<double>& r = before[static_cast<std::size_t>(p)];
            for (int k = 0; k < 9; ++k) s.f.m[k] = static_cast<double>(call->state[k][p]);
            // F errs by up to 16 ulp (above), and so does what is stored, times the stress.
            const double stiff = v["density"] * r.sound_speed * r.sound_speed;
            ASSERT_LE(exact.respond(s).energy, r.energy + 16 * ulp * stiff) << text_of(v);
          }
        }
      }
    });
  }
}

TEST(Lanes, SvdAsInPlainFloats) {
  for (const Isa& isa : instruction_sets()) {
    SCOPED_TRACE(isa.name);
    auto call = std::make_unique<SvdCall>();
    Rng rng(12);
    Worst values, rebuilt, turned;
    for (int round = 0; round < 20; ++round) {
      std::vector<Mat3<float>> all;
      for (int p = 0; p < lanes_tested; ++p) {
        Mat3d f = random_matrix(rng, 1);
        if (p % 4 == 1) f = Mat3d::identity() + f * 1e-3;
        if (p % 4 == 2) f = random_rotation(rng) * Mat3d::diagonal(2, 1, -0.3) * random_rotation(rng);
        if (p % 64 == 3) f = p % 128 == 3 ? Mat3d{} : Mat3d::identity();
        all.push_back(static_cast<Mat3<float>>(f));
        for (int k = 0; k < 9; ++k) call->f[k][p] = all.back().m[k];
      }
      isa.lanes.svd(*call);
      for (int p = 0; p < lanes_tested; ++p) {
        const Mat3<float>& f = all[static_cast<std::size_t>(p)];
        const auto want = svd3(f);
        Mat3<float> u, vt;
        Vec3<float> s;
        for (int k = 0; k < 9; ++k) u.m[k] = call->u[k][p], vt.m[k] = call->v[k][p];
        for (int k = 0; k < 3; ++k) s[k] = call->s[k][p];
        const double scale = std::max(static_cast<double>(std::abs(want.s.x)), 1e-30);
        for (int k = 0; k < 3; ++k) values.see(s[k], want.s[k], scale);
        // Vectors of near-equal values are free to differ; what they make together is not.
        const Mat3<float> back = u * Mat3<float>::diagonal(s.x, s.y, s.z) * transpose(vt);
        for (int k = 0; k < 9; ++k) rebuilt.see(back.m[k], f.m[k], scale);
        const Mat3<float> unit = transpose(u) * u;
        for (int k = 0; k < 9; ++k) turned.see(unit.m[k], k % 4 == 0 ? 1.0f : 0.0f, 1);
      }
    }
    std::printf("svd3 on %s: values %.1f, rebuilt F %.1f, U^T U %.1f ulp\n", isa.name, values.ulps, rebuilt.ulps,
                turned.ulps);
    EXPECT_LE(values.ulps, 16);
    EXPECT_LE(rebuilt.ulps, 32);
    EXPECT_LE(turned.ulps, 32);
  }
}

TEST(Lanes, ExpAndLogAsInPlainFloats) {
  for (const Isa& isa : instruction_sets()) {
    SCOPED_TRACE(isa.name);
    auto call = std::make_unique<ExpLogCall>();
    Rng rng(13);
    Worst e, l;
    for (int round = 0; round < 50; ++round) {
      for (int p = 0; p < lanes_tested; ++p) {
        call->a[p] = static_cast<float>(between(rng, -90, 90));
        call->b[p] = static_cast<float>(std::exp(between(rng, -80, 80)));
      }
      isa.lanes.exp_log(*call);
      for (int p = 0; p < lanes_tested; ++p) {
        const float we = exp(call->a[p]), wl = log(call->b[p]);
        e.see(call->exp_a[p], we, static_cast<double>(we));
        l.see(call->log_b[p], wl, std::max(1.0, std::abs(static_cast<double>(wl))));
      }
    }
    std::printf("exp, log on %s: %.1f, %.1f ulp\n", isa.name, e.ulps, l.ulps);
    EXPECT_LE(e.ulps, 4);
    EXPECT_LE(l.ulps, 4);
  }
}

}  // namespace
}  // namespace dreampm
