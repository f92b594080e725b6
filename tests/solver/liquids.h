// Liquids at rest under their own weight, for tests.
#pragma once
#include "worlds.h"

namespace dreampm::test {

/// A column of rest height H that gravity has pressed: p = rho0 g (H - Y) in the heights Y from before, whatever the
/// equation of state.
class Hydrostatic {
 public:
  Hydrostatic(const Values& values, double g, double height)
      : gamma_(values["gamma"]), bulk_(values["bulk_modulus"]), weight_(values["density"] * g), height_(height) {}

  /// p [Pa] of e = J - 1.
  double pressure(double e) const { return bulk_ / gamma_ * (std::pow(1 + e, -gamma_) - 1); }
  double strain(double p) const { return std::pow(1 + gamma_ * p / bulk_, -1 / gamma_) - 1; }
  /// The pressed height [m] of rest height `Y`: the integral of J.
  double pressed(double Y) const {
    const double a = 1 - 1 / gamma_;
    const auto f = [&](double p) { return bulk_ / (gamma_ * a) * std::pow(1 + gamma_ * p / bulk_, a); };
    return (f(weight_ * height_) - f(weight_ * (height_ - Y))) / weight_;
  }
  /// p [Pa] at a pressed height; 0 above the surface.
  double pressure_at(double y) const {
    double low = 0, high = height_;
    if (y >= pressed(height_)) return 0;
    for (int i = 0; i < 60; ++i) (pressed((low + high) / 2) < y ? low : high) = (low + high) / 2;
    return weight_ * (height_ - low);
  }
  /// A pressed block from the origin, of rest size `size`.
  std::vector<Newborn> fill(const Vec3d& size, double spacing) const {
    auto all = lattice({{}, size}, spacing, still());
    for (Newborn& n : all) n.position.y = pressed(n.position.y);
    return all;
  }
  /// Gives set 0 of a world just begun its pressure.
  template <class R>
  void press(World<R>& w, const std::vector<Newborn>& newborns) const {
    auto& set = w.sets[0];
    for (std::size_t p = 0; p < set.size(); ++p)
      set.state[0][p] = static_cast<R>(strain(pressure_at(newborns.at(set.id[p]).position.y)));
  }

 private:
  double gamma_, bulk_, weight_, height_;
};

}  // namespace dreampm::test
