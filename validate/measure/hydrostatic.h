// A liquid pressed by its own weight: the exact rest state of a column, whatever its equation of
// state.
#pragma once
#include <algorithm>
#include <vector>

#include "dreampm/physics/materials/newtonian.h"
#include "dreampm/state/regroup.h"
#include "validate/measure/particles.h"

namespace dreampm::validate {

/// A column of rest height H: p = rho0 g (H - Y) in the heights Y from before it was pressed.
/// Heights count from its base [m].
class Hydrostatic {
 public:
  /// `values` of the newtonian law, complete; g > 0 [m/s^2].
  Hydrostatic(const Values& values, double g, double height)
      : law_(Newtonian::Law<double>::from(values)), weight_(values["density"] * g), height_(height) {
    // y(Y) is the integral of J; the trapezium's error is (H/n)^2/12 times a curvature of about
    // rho0 g/K.
    pressed_.push_back(0);
    for (int i = 0; i < parts; ++i)
      pressed_.push_back(pressed_.back() + height / parts *
                                               (1 + 0.5 * (strain(weight_ * (height - rest_height(i))) +
                                                           strain(weight_ * (height - rest_height(i + 1))))));
  }

  /// p [Pa] of e = J - 1.
  double pressure(double e) const { return -law_.respond(Newtonian::State<double>{e}).tau.xx / (1 + e); }
  /// e = J - 1 of p >= 0 [Pa].
  double strain(double p) const {
    double low = -0.6, high = 0;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (pressure(middle) > p ? low : high) = middle;
    }
    return (low + high) / 2;
  }
  /// Returns the place under load of the matter from rest height Y.
  double pressed(double Y) const {
    const double at = std::clamp(Y / height_, 0.0, 1.0) * parts;
    const int i = std::min(static_cast<int>(at), parts - 1);
    return part(i) + (part(i + 1) - part(i)) * (at - i);
  }
  /// p [Pa] at a pressed height; 0 above the surface.
  double pressure_at(double y) const {
    if (y >= pressed_.back()) return 0;
    const auto above = std::upper_bound(pressed_.begin(), pressed_.end(), std::max(y, 0.0));
    const int i = static_cast<int>(above - pressed_.begin()) - 1;
    const double Y = rest_height(i) + height_ / parts * (std::max(y, 0.0) - part(i)) / (part(i + 1) - part(i));
    return weight_ * (height_ - Y);
  }
  /// Moves seeds to their pressed heights over `base` [m].
  void move(std::vector<ParticleSeed>& seeds, double base = 0) const {
    for (ParticleSeed& n : seeds) n.position.y = base + pressed(n.position.y - base);
  }
  /// Gives a liquid set of a world just begun the pressure of its heights over `base` [m].
  template <class R>
  void press(World<R>& w, std::size_t set = 0, double base = 0) const {
    auto& e = state_column(w.sets.at(set), "e");
    each_particle(w, [&](std::size_t s, std::size_t p, const Vec3d& at) {
      if (s == set) e[p] = static_cast<R>(strain(pressure_at(at.y - base)));
    });
  }

 private:
  static constexpr int parts = 1024;
  double rest_height(int i) const { return height_ * i / parts; }
  double part(int i) const { return pressed_[static_cast<std::size_t>(i)]; }
  Newtonian::Law<double> law_;
  double weight_, height_;
  std::vector<double> pressed_;  ///< at rest heights i H/parts
};

}  // namespace dreampm::validate
