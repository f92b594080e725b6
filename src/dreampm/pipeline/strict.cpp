#include "dreampm/pipeline/strict.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dreampm {
namespace {

constexpr double mass_rounding = 1e-12;  // sums of equal numbers in double
constexpr double grid_rounding = 16 * std::numeric_limits<float>::epsilon();

/// Of what emitters gave; 0 in a run without any.
double entered(const LedgerRow& row, const std::string& column) {
  const auto found = row.values.find(column);
  return found == row.values.end() ? 0 : found->second;
}

std::optional<std::string> mass_breach(const LedgerRow& before, const LedgerRow& now) {
  const auto at = [](const LedgerRow& r, const char* column) { return r.values.at(column); };
  const double lost =
      at(before, "particles") + at(before, "left") + entered(now, "entered") - at(now, "particles") - at(now, "left");
  if (lost != 0) return fmt::format("{:.0f} particles are neither there nor have left", lost);
  const double expected = at(before, "mass") + entered(now, "entered_mass") - at(now, "left_mass"),
               mass = at(now, "mass");
  if (std::abs(mass - expected) > mass_rounding * std::max(at(before, "mass"), mass))
    return fmt::format("mass is {} kg; {} kg were there, {} kg came in and {} kg left", mass, at(before, "mass"),
                       entered(now, "entered_mass"), at(now, "left_mass"));
  // The grid was visited before what left in its last step was taken out.
  const double there = at(before, "mass") + entered(now, "entered_mass");
  const double grid = at(now, "grid_mass"), slack = grid_rounding * there;
  if (grid < mass - slack || grid > there + slack) return fmt::format("the grid holds {} kg of {} kg", grid, mass);
  return std::nullopt;
}

std::optional<std::string> vector_breach(const LedgerRow& before, const LedgerRow& now, const std::string& quantity,
                                         const std::string& received, const char* unit) {
  const double bound = now.values.at(quantity + "_bound");
  for (const char axis : {'x', 'y', 'z'}) {
    const auto column = [&](const std::string& name) { return now.values.at(fmt::format("{}_{}", name, axis)); };
    const std::string name = fmt::format("{}_{}", quantity, axis);
    const double change = now.values.at(name) - before.values.at(name);
    const double walls = column("wall_" + received), body = column("body_" + received),
                 left = column("left_" + quantity), came = entered(now, fmt::format("entered_{}_{}", quantity, axis));
    const double gap = change - (walls + body + came - left);
    if (!(std::abs(gap) <= bound))
      return fmt::format(
          "{} changed by {:.6g} {}; walls and colliders gave {:.6g}, gravity, damping and fields {:.6g}, {:.6g} left: "
          "a "
          "gap of {:.3g}, while rounding explains {:.3g}",
          name, change, unit, walls, body, left, gap, bound);
  }
  return std::nullopt;
}

std::optional<std::string> energy_breach(const LedgerRow& now) {
  // What the nodes' velocities gain beyond what stress had to give is in the rest, and particles do
  // not take it over: of that loop no energy stays. In sub-cycled steps the heat of viscosity is
  // what is left over: below 0 it is no heat.
  const double kept = now.values.at("dissipated_rest") + now.values.at("dissipated_transfer") +
                      std::min(0.0, now.values.at("dissipated_viscosity"));
  const double bound = now.values.at("energy_bound");
  if (kept >= -bound) return std::nullopt;  // not so of what is no number
  return fmt::format("energy: {:.6g} J came from nowhere, while an explicit step explains {:.3g}", -kept, bound);
}

}  // namespace

std::optional<std::string> ledger_breach(const LedgerRow& before, const LedgerRow& now) {
  auto breach = mass_breach(before, now);
  if (!breach) breach = vector_breach(before, now, "momentum", "impulse", "N s");
  if (!breach) breach = vector_breach(before, now, "angular", "angular", "N m s");
  if (!breach) breach = energy_breach(now);
  if (!breach) return std::nullopt;
  return fmt::format("the ledger does not close at frame {}: {}", now.frame, *breach);
}

}  // namespace dreampm
