// Random states of any material: what a law makes of a random past.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "dreampm/physics/materials.h"

namespace dreampm::test {

using Rng = std::mt19937_64;

inline double between(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

inline Mat3d random_matrix(Rng& rng, double size) {
  Mat3d m;
  for (double& x : m.m) x = between(rng, -size, size);
  return m;
}

inline Mat3d random_rotation(Rng& rng) {
  std::normal_distribution<double> g;
  const Vec3d a = normalized(Vec3d{g(rng), g(rng), g(rng)});
  Vec3d b{g(rng), g(rng), g(rng)};
  b = normalized(b - a * dot(a, b));
  const Vec3d c = cross(a, b);
  return {{a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z}};
}

/// Complete values: what is derived gets a number of its own.
inline Values complete(const MaterialInfo& info, Values v = {}) {
  v.with_defaults(info.params);
  for (const Param& p : info.params)
    if (!v.has(p.key)) v.set(p.key, 1e6);
  return v;
}

inline std::string text_of(const Values& v) {
  std::string text;
  for (const auto& [key, value] : v) text += key + " " + std::to_string(value) + ", ";
  return text;
}

/// A value of those allowed: a word, an end of [min, max], or any between (evenly in decades where
/// a slider moves in decades), now and then a whole one, since laws take ways of their own for
/// whole exponents.
inline double pick(const Param& p, Rng& rng) {
  if (!p.words.empty() && (p.words_only || rng() % 4 == 0)) return p.words[rng() % p.words.size()].value;
  const double low = p.log && p.min <= 0 ? p.max * 1e-9 : p.min, x = between(rng, 0, 1);
  const double any = p.log ? low * std::pow(p.max / low, x) : low + (p.max - low) * x, whole = std::round(any);
  switch (rng() % 4) {
    case 0:
      return p.min;
    case 1:
      return p.max;
    case 2:
      return p.min < whole && whole < p.max ? whole : any;
    default:
      return any;
  }
}

/// The defaults, each preset, and `draws` from the ranges of all parameters or of one in three, so
/// that switches also meet plain company. If any, every word and every end is among them, and of
/// numbers something between.
inline std::vector<Values> kinds(const MaterialInfo& info, int draws, Rng& rng) {
  std::vector<Values> all{complete(info)};
  for (const Preset& preset : info.presets) {
    Values v;
    for (const Preset::Value& x : preset.values) v.set(x.key, x.value);
    all.push_back(complete(info, v));
  }
  for (int draw = 0; draw < draws; ++draw) {
    Values v;
    for (const Param& p : info.params)
      if (draw % 2 || rng() % 3 == 0) v.set(p.key, pick(p, rng));
    all.push_back(complete(info, v));
  }
  if (draws == 0) return all;
  for (const Param& p : info.params) {
    const auto met = [&](const auto& wanted) {
      return std::any_of(all.begin(), all.end(), [&](const Values& v) { return wanted(v[p.key]); });
    };
    for (const Word& w : p.words)
      EXPECT_TRUE(met([&](double x) { return x == w.value; })) << info.name << " never met " << p.key << ": " << w.name;
    for (const double end : {p.min, p.max})
      EXPECT_TRUE(met([&](double x) { return x == end; })) << info.name << " never met " << p.key << ": " << end;
    EXPECT_TRUE(p.words_only || met([&](double x) { return p.min < x && x < p.max; })) << info.name << " " << p.key;
  }
  return all;
}

/// Values in range, and a bulk modulus where one would be derived. The report's program has no
/// bound on its exponent, and overflows where it overflowed.
inline Values within_range(const MaterialInfo& info, Values v) {
  v = complete(info, v);
  if (v.has("legacy")) v.set("legacy", 0);
  return v;
}

template <class M, class R>
typename M::template State<R> rest_state() {
  typename M::template State<R> s;
  for (int c = 0; c < state_columns<M>; ++c) s[c] = static_cast<R>(M::template State<R>::rest[c]);
  return s;
}

template <class R>
StrainIncrement<R> local(const Mat3<R>& gradient, double density = 1, double dt = 1e-4) {
  return {gradient, static_cast<R>(dt), static_cast<R>(1 / density), static_cast<R>(1e-4)};
}

/// A state after `steps` random gradients of up to `size`.
template <class M, class R>
typename M::template State<R> random_state(const typename M::template Law<R>& law, Rng& rng, double size,
                                           int steps = 6) {
  auto s = rest_state<M, R>();
  for (int i = 0; i < steps; ++i)
    law.advance(s, local<R>(static_cast<Mat3<R>>(random_matrix(rng, size)), between(rng, 0.9, 1.1)));
  return s;
}

/// m^2/s: the kinematic viscosity that `step(state, at)` acts with. The same strain in half of a
/// very short time changes the stress of what is elastic, or flows implicitly, by a strain times a
/// modulus at most; explicit viscosity doubles its own.
template <class State, class Step>
double viscosity_seen(double density, const State& before, const Mat3d& strain, double dt, const Step& step) {
  State slow = before, fast = before;
  const Mat3d more = step(fast, local(strain, 1, dt / 2)).tau.full() - step(slow, local(strain, 1, dt)).tau.full();
  return std::sqrt(norm2(more)) * dt / (2 * density * std::sqrt(norm2(symmetric_part(strain).full())));
}

/// Returns the fault of the viscosity that a law reports in a state, or nothing. Steps are bounded
/// by the reported viscosity, and only that which `add_viscous` adds can be sub-cycled.
template <class M>
std::string viscosity_complaint(const typename M::template Law<double>& law, const Values& v,
                                const typename M::template State<double>& s, const Mat3d& strain) {
  constexpr double dt = 1e-20;  // s: at a sound of 1 km/s stiffness looks like a viscosity of 5e-13 m^2/s
  auto after = s;
  const auto r = advanced(law, after, local(strain, 1, dt));
  const double elastic = 5 * r.sound_speed * r.sound_speed * dt / std::sqrt(norm2(symmetric_part(strain).full()));
  const auto seen = [&](const auto& step) { return viscosity_seen(v["density"], s, strain, dt, step); };
  const double own = seen([&](auto& state, const auto& at) { return law.advance(state, at); }),
               whole = seen([&](auto& state, const auto& at) { return advanced(law, state, at); });
  if (whole > r.kinematic_viscosity * (1 + 1e-9) + elastic) return "acts with more viscosity than it reports";
  if (Viscous<M> && own > elastic) return "has a viscosity in `advance` beside that of `add_viscous`";
  return "";
}

/// F of stretches from near 1 to far from it, one in eight inside out.
inline Mat3d any_stretched(Rng& rng) {
  const double size = std::pow(10, between(rng, -4, 0.2));
  const auto stretch = [&] { return std::exp(between(rng, -size, size)); };
  return random_rotation(rng) * Mat3d::diagonal(stretch(), stretch(), rng() % 8 ? stretch() : -stretch()) *
         random_rotation(rng);
}

/// Values anywhere in their ranges of a law that clamps stretches, hardening aside.
inline Values any_clamping(const MaterialInfo& info, Rng& rng) {
  Values v;
  for (const Param& p : info.params) v.set(p.key, pick(p, rng));
  v.set("hardening", 0);
  if (info.find("elastic")) v.set("elastic", 0);
  return within_range(info, v);
}

/// True if the law clamps stretches.
template <class M>
constexpr bool clamps() {
  return M::info.name == "snow" || M::info.name == "seed";
}

/// True if the state begins with the deformation gradient F.
template <class M>
constexpr bool stores_f() {
  return state_columns<M> >= 9 && M::template State<float>::names[0] == std::string_view("f_00");
}
/// True if the state begins with e = J - 1.
template <class M>
constexpr bool stores_e() {
  return M::template State<float>::names[0] == std::string_view("e");
}

}  // namespace dreampm::test
