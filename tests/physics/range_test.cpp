// Every law over the whole range of its parameters, with strains far beyond what a good step
// brings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "states.h"

namespace dreampm {
namespace {
using namespace test;

/// How much stiffer a law can become than it is at rest, strain aside.
double hardening_of(const MaterialInfo& info, const Values& v) {
  // Jp stops at 0.1 in `seed`, at 0.6 in `snow`.
  return v.has("hardening") ? std::exp((info.name == "seed" ? 0.45 : 0.2) * v["hardening"]) : 1;
}

/// Returns the fault of an answer, or nothing. Stress is a strain times a modulus and a viscosity
/// times a rate: neither may be beyond the reported bounds.
template <class M, class R>
std::string complaint(const Values& v, typename M::template State<R> s, const StressResponse<R>& r,
                      const StrainIncrement<R>& at, double fastest) {
  double sum = static_cast<double>(r.energy);
  for (int c = 0; c < state_columns<M>; ++c) sum += static_cast<double>(s[c]);
  double tau = 0;
  for (const R x : r.tau.full().m) tau = std::max(tau, std::abs(static_cast<double>(x))), sum += static_cast<double>(x);
  const double c = static_cast<double>(r.sound_speed), nu = static_cast<double>(r.kinematic_viscosity);
  if (!std::isfinite(sum + c + nu)) return "not finite";
  if (!(c > 0) || c > fastest) return "wave speed " + std::to_string(c);
  if (nu < 0) return "viscosity " + std::to_string(nu);
  if (nu > 0 && !Viscous<M>) return "a viscosity that nothing adds the stress of";
  const double rate = std::sqrt(norm2(static_cast<Mat3d>(at.gradient))) / static_cast<double>(at.dt);
  const double bound = v["density"] * (5 * c * c + 2 * nu * rate);
  if (tau > bound) return "stress " + std::to_string(tau) + " of " + std::to_string(bound);
  return "";
}

/// Eight random steps from rest, one of them inside out.
template <class M, class R>
std::string violent_past(const Values& v, Rng& rng) {
  const auto law = M::template Law<R>::from(v);
  auto s = rest_state<M, R>();
  // A particle of these pasts is stretched and swollen less than a million times.
  const double fastest = 1e6 * hardening_of(M::info, v) * static_cast<double>(law.respond(s).sound_speed);
  for (int i = 0; i < 8; ++i) {
    const auto at = local<R>(static_cast<Mat3<R>>(random_matrix(rng, i == 4 ? 2.5 : 0.2)), between(rng, 0, 3),
                             std::pow(10.0, between(rng, -7, -2)));
    const auto r = advanced(law, s, at);
    const std::string wrong = complaint<M, R>(v, s, r, at, fastest);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

template <class R>
void random_values() {
  Materials::for_each([]<class M>() {
    SCOPED_TRACE(M::info.name);
    Rng rng(7);
    int failures = 0;
    for (int trial = 0; trial < 3000 && failures < 5; ++trial) {
      Values v;
      for (const Param& p : M::info.params)
        if (trial % 3 == 0 || rng() % 3 == 0) v.set(p.key, pick(p, rng));
      v = within_range(M::info, v);
      const std::string wrong = violent_past<M, R>(v, rng);
      if (!wrong.empty()) ADD_FAILURE() << wrong << " with " << text_of(v), ++failures;
    }
  });
}
TEST(Range, RandomValuesFloat) { random_values<float>(); }
TEST(Range, RandomValuesDouble) { random_values<double>(); }

TEST(Range, EveryCornerFloat) {
  Materials::for_each([]<class M>() {
    SCOPED_TRACE(M::info.name);
    Rng rng(8);
    int failures = 0;
    for (unsigned corner = 0; corner < 1u << M::info.params.size() && failures < 5; ++corner) {
      Values v;
      for (std::size_t k = 0; k < M::info.params.size(); ++k) {
        const Param& p = M::info.params[k];
        v.set(p.key, corner >> k & 1 ? p.max : p.min);
      }
      v = within_range(M::info, v);
      for (int trial = 0; trial < 3; ++trial) {
        const std::string wrong = violent_past<M, float>(v, rng);
        if (!wrong.empty()) ADD_FAILURE() << wrong << " with " << text_of(v), ++failures;
      }
    }
  });
}

TEST(Range, LongPastsOfBoundedStrainStayBounded) {
  // The whole deformation is turned, stretched up to 3 times and inverted, over and over: what a
  // law makes of it may not grow with the number of steps. 1e3 bounds the stiffening of 3 fold
  // stretch (27 fold volume squared).
  Materials::for_each([]<class M>() {
    SCOPED_TRACE(M::info.name);
    Rng rng(9);
    int failures = 0;
    for (int trial = 0; trial < 60 && failures < 5; ++trial) {
      Values v;
      if (trial > 20)
        for (const Param& p : M::info.params) v.set(p.key, pick(p, rng));
      v = within_range(M::info, v);
      const auto law = M::template Law<float>::from(v);
      auto s = rest_state<M, float>();
      const double fastest = 1e3 * hardening_of(M::info, v) * static_cast<double>(law.respond(s).sound_speed);
      Mat3d whole = Mat3d::identity();
      for (int i = 0; i < 400; ++i) {
        const auto stretch = [&] { return std::exp(between(rng, -1.1, 1.1)); };
        const Mat3d next = random_rotation(rng) *
                           Mat3d::diagonal(stretch(), stretch(), rng() % 8 ? stretch() : -stretch()) *
                           random_rotation(rng);
        const Mat3d inverse = transpose(cofactor(whole)) * (1 / determinant(whole));
        const auto at = local<float>(static_cast<Mat3f>(next * inverse - Mat3d::identity()), between(rng, 0.3, 3));
        const auto r = advanced(law, s, at);
        whole = next;
        // Newtonian and elastic laws follow F or J; what rounding left of 400 inversions is still
        // near.
        const std::string wrong = complaint<M, float>(v, s, r, at, fastest);
        if (!wrong.empty()) {
          ADD_FAILURE() << wrong << " at step " << i << " with " << text_of(v), ++failures;
          break;
        }
      }
    }
  });
}

/// The largest stretch over the least, and at least what the bounds of Hencky's law allow, e^(1/3)
/// over 0.2117: what rounding of the one makes of the other, and of its logarithm.
template <class M, class State>
double conditioning(const State& s) {
  double ratio = 6.6;
  if constexpr (stores_f<M>()) {
    const auto stretches = svd3(s.f).s;
    ratio = std::max(ratio, static_cast<double>(stretches.x / std::abs(stretches.z)));
  }
  return ratio;
}

template <class R>
void idempotent() {
  // A step of no strain in no time, after any step, leaves the state where it is: what `advance`
  // projects stays.
  Materials::for_each([]<class M>() {
    SCOPED_TRACE(M::info.name);
    Rng rng(10);
    double most = 0;
    for (const Values& v : kinds(M::info, 2000, rng)) {
      const auto law = M::template Law<R>::from(v);
      auto s = rest_state<M, R>();
      for (int i = 0; i < 4; ++i)
        law.advance(s, local<R>(static_cast<Mat3<R>>(random_matrix(rng, i == 2 ? 1.0 : 0.1)), between(rng, 0.9, 1.1)));
      auto again = s;
      law.advance(again, StrainIncrement<R>{{}, R(1e-25), R(1), R(0)});
      double size = 1, change = 0;
      for (int c = 0; c < state_columns<M>; ++c) {
        const double moved = std::abs(static_cast<double>(again[c] - s[c]));
        size = std::max(size, std::abs(static_cast<double>(s[c])));
        if (moved > change || std::isnan(moved)) change = moved;
      }
      change /= size * static_cast<double>(std::numeric_limits<R>::epsilon());
      // U, exp and log are good to a few ulp each, eight in all.
      EXPECT_LE(change, 8 * conditioning<M>(s)) << text_of(v);
      most = std::max(most, change);
    }
    std::printf("%s: a second projection moves by %.1f epsilon\n", std::string(M::info.name).c_str(), most);
  });
}
TEST(Range, ProjectingTwiceIsProjectingOnceDouble) { idempotent<double>(); }
TEST(Range, ProjectingTwiceIsProjectingOnceFloat) { idempotent<float>(); }

TEST(Tables, DefaultsAndPresetsLieInTheirRangesAndNameTheirSource) {
  // The year of a publication, or a collection or standard without one.
  const auto names_publication =
      testing::ContainsRegex("(^|[^0-9])(18|19|20)[0-9]{2}([^0-9]|$)|[Hh]andbook|MatWeb|USACE EM");
  for (const MaterialInfo& m : material_infos()) {
    SCOPED_TRACE(m.name);
    for (const Param& p : m.params) {
      EXPECT_LT(p.min, p.max) << p.key;
      EXPECT_FALSE(p.help.empty()) << p.key;
      EXPECT_TRUE(std::isnan(p.value) || (p.min <= p.value && p.value <= p.max)) << p.key;
    }
    for (const Preset& preset : m.presets) {
      EXPECT_THAT(std::string(preset.source), names_publication) << preset.name;
      for (const Preset::Value& v : preset.values) {
        const Param* p = m.find(v.key);
        ASSERT_NE(p, nullptr) << preset.name << " " << v.key;
        EXPECT_TRUE(p->min <= v.value && v.value <= p->max) << preset.name << " " << v.key;
      }
    }
  }
}

TEST(Tables, ImpliedNumbersAreThoseOfTheLaw) {
  const auto facts = [](std::string_view name, std::initializer_list<std::pair<std::string_view, double>> given) {
    Values v;
    for (const auto& [key, value] : given) v.set(key, value);
    const MaterialInfo& info = *find_material(name);
    return facts_of(info, complete(info, v));
  };
  // The report's slider: mu = E V, lambda = E (1 - V), so nu = lambda/(2 (lambda + mu)) = (1 -
  // V)/2.
  EXPECT_NEAR(facts("seed", {{"v", 0.3}}).poissons_ratio, 0.35, 1e-4);
  for (const std::string_view name : {"elastic", "neo_hookean", "snow", "sand"}) {
    const MaterialFacts f = facts(name, {{"density", 900}, {"youngs_modulus", 2e5}, {"poissons_ratio", 0.3}});
    EXPECT_NEAR(f.poissons_ratio, 0.3, 1e-4) << name;
    EXPECT_NEAR(f.sound_speed, std::sqrt(2e5 * 0.7 / (1.3 * 0.4) / 900), 1e-9) << name;
    EXPECT_EQ(f.kinematic_viscosity, 0) << name;
  }
  const MaterialFacts mud = facts("viscoplastic", {{"density", 1500}, {"shear_modulus", 3e4}, {"bulk_modulus", 6e4}});
  EXPECT_NEAR(mud.poissons_ratio, (3 * 6e4 - 2 * 3e4) / (2 * (3 * 6e4 + 3e4)), 1e-5);
  EXPECT_NEAR(mud.sound_speed, std::sqrt((6e4 + 4e4) / 1500), 1e-9);
}

}  // namespace
}  // namespace dreampm
