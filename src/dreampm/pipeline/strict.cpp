#include "dreampm/pipeline/strict.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dreampm {
namespace {

constexpr double mass_rounding = 1e-12;  // sums of equal numbers in double
constexpr double grid_rounding = 16 * std::numeric_limits<float>::epsilon();

std::optional<std::string> mass_breach(const LedgerRow& before, const LedgerRow& now) {
  const double lost = before.particles + before.left + now.entered - now.particles - now.left;
  if (lost != 0) return fmt::format("{:.0f} particles are neither there nor have left", lost);
  const double expected = before.mass + now.entered_mass - now.left_mass;
  if (std::abs(now.mass - expected) > mass_rounding * std::max(before.mass, now.mass))
    return fmt::format("mass is {} kg; {} kg were there, {} kg came in and {} kg left", now.mass, before.mass,
                       now.entered_mass, now.left_mass);
  // The grid was visited before what left in its last step was taken out.
  const double there = before.mass + now.entered_mass, slack = grid_rounding * there;
  if (now.grid_mass < now.mass - slack || now.grid_mass > there + slack)
    return fmt::format("the grid holds {} kg of {} kg", now.grid_mass, now.mass);
  return std::nullopt;
}

/// A vector that is conserved, and what changes it.
struct VectorBalance {
  std::string_view quantity, unit;
  Vec3d LedgerRow::*amount, LedgerRow::*walls, LedgerRow::*body, LedgerRow::*left, LedgerRow::*entered;
  double LedgerRow::* bound;
};
constexpr VectorBalance vector_balances[] = {
    {ledger_column(&LedgerRow::momentum).name, ledger_column(&LedgerRow::momentum).unit, &LedgerRow::momentum,
     &LedgerRow::wall_impulse, &LedgerRow::body_impulse, &LedgerRow::left_momentum, &LedgerRow::entered_momentum,
     &LedgerRow::momentum_bound},
    {ledger_column(&LedgerRow::angular).name, ledger_column(&LedgerRow::angular).unit, &LedgerRow::angular,
     &LedgerRow::wall_angular, &LedgerRow::body_angular, &LedgerRow::left_angular, &LedgerRow::entered_angular,
     &LedgerRow::angular_bound}};

std::optional<std::string> vector_breach(const LedgerRow& before, const LedgerRow& now, const VectorBalance& b) {
  for (int a = 0; a < 3; ++a) {
    const double change = (now.*b.amount)[a] - (before.*b.amount)[a];
    const double walls = (now.*b.walls)[a], body = (now.*b.body)[a], left = (now.*b.left)[a];
    const double gap = change - (walls + body + (now.*b.entered)[a] - left), bound = now.*b.bound;
    if (!(std::abs(gap) <= bound))
      return fmt::format(
          "{}_{} changed by {:.6g} {}; walls and colliders gave {:.6g}, gravity, damping and fields {:.6g}, {:.6g} "
          "left: a gap of {:.3g}, while rounding explains {:.3g}",
          b.quantity, static_cast<char>('x' + a), change, b.unit, walls, body, left, gap, bound);
  }
  return std::nullopt;
}

std::optional<std::string> energy_breach(const LedgerRow& now) {
  // What the nodes' velocities gain beyond what stress had to give is in the rest, and particles do
  // not take it over: of that loop no energy stays. In sub-cycled steps the heat of viscosity is
  // what is left over: below 0 it is no heat.
  const double kept = now.dissipated_rest + now.dissipated_transfer + std::min(0.0, now.dissipated_viscosity);
  const double bound = now.energy_bound;
  if (kept >= -bound) return std::nullopt;  // not so of what is no number
  return fmt::format("energy: {:.6g} J came from nowhere, while an explicit step explains {:.3g}", -kept, bound);
}

}  // namespace

std::optional<std::string> ledger_breach(const LedgerRow& before, const LedgerRow& now) {
  auto breach = mass_breach(before, now);
  for (const VectorBalance& balance : vector_balances)
    if (!breach) breach = vector_breach(before, now, balance);
  if (!breach) breach = energy_breach(now);
  if (!breach) return std::nullopt;
  return fmt::format("the ledger does not close at frame {}: {}", now.frame, *breach);
}

}  // namespace dreampm
