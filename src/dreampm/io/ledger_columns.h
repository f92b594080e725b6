// The columns of ledger.csv, each given once: writer, reader and the page docs/reference/ledger.md
// follow from this table.
#pragma once
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dreampm/physics/dt.h"
#include "dreampm/vec.h"

namespace dreampm {

/// One frame, in SI units. Sums are over the steps since the row before. Unit and meaning of each
/// member stand in its row of `ledger_columns`.
struct LedgerRow {
  int frame = 1;
  Limiter limiter = Limiter::frame;
  double time = 0, substeps = 0, dt_min = 0, dt_max = 0, stages = 0;
  double particles = 0, left = 0, mass = 0, left_mass = 0, grid_mass = 0;
  Vec3d momentum{}, angular{};
  double kinetic = 0, elastic = 0, gravity = 0, work = 0, power = 0;
  double dissipated = 0, dissipated_viscosity = 0, dissipated_plasticity = 0, dissipated_relaxation = 0;
  double dissipated_friction = 0, dissipated_transfer = 0, dissipated_damping = 0, dissipated_rest = 0;
  Vec3d wall_impulse{}, wall_angular{}, body_impulse{}, body_angular{}, left_momentum{}, left_angular{};
  double momentum_bound = 0, angular_bound = 0, energy_bound = 0;
  double volume = 0, j_min = 0, j_max = 0, swollen = 0;
  double entered = 0, entered_mass = 0, entered_energy = 0;
  Vec3d entered_momentum{}, entered_angular{};
  double dissipated_projection = 0;
};

/// Tables of the page, in its order.
enum class LedgerGroup { steps, mass, momentum, energy, losses, volume };

/// Runs whose ledger has a column.
enum class LedgerRuns { all, with_emitters, by_projection };

/// A column, or the three of a vector.
struct LedgerColumn {
  std::string_view name;  ///< of a vector without `_x`, `_y`, `_z`
  std::string_view unit;  ///< empty: a count, a ratio or a word
  LedgerGroup group;
  std::variant<int LedgerRow::*, Limiter LedgerRow::*, double LedgerRow::*, Vec3d LedgerRow::*> value;
  std::string_view meaning;  ///< for the page, in Markdown
  LedgerRuns runs = LedgerRuns::all;
};

/// All columns, in the order of the file.
inline constexpr LedgerColumn ledger_columns[] = {
    {"frame", "", LedgerGroup::steps, &LedgerRow::frame, "The frame, from 1."},
    {"time", "s", LedgerGroup::steps, &LedgerRow::time, "Its time."},
    {"substeps", "", LedgerGroup::steps, &LedgerRow::substeps, "Number of steps since the row before."},
    {"dt_min", "s", LedgerGroup::steps, &LedgerRow::dt_min, "The shortest of these steps."},
    {"dt_max", "s", LedgerGroup::steps, &LedgerRow::dt_max, "The longest of these steps."},
    {"limiter", "", LedgerGroup::steps, &LedgerRow::limiter,
     "What bounded the shortest step ([the time step](../theory/step.md#the-time-step))."},
    {"stages", "", LedgerGroup::steps, &LedgerRow::stages,
     "The most [stages of viscosity](../theory/liquid.md#viscosity-in-stages) in a step; 0 where all were explicit."},
    {"particles", "", LedgerGroup::mass, &LedgerRow::particles, "Particles in the scene."},
    {"left", "", LedgerGroup::mass, &LedgerRow::left, "Particles out through open walls and sinks, in all."},
    {"mass", "kg", LedgerGroup::mass, &LedgerRow::mass, "Mass in the scene."},
    {"left_mass", "kg", LedgerGroup::mass, &LedgerRow::left_mass, "Mass that left since the row before."},
    {"grid_mass", "kg", LedgerGroup::mass, &LedgerRow::grid_mass,
     "Mass on the nodes in the last step: what a transfer could lose."},
    {"momentum", "N s", LedgerGroup::momentum, &LedgerRow::momentum, "Momentum of all matter."},
    {"angular", "N m s", LedgerGroup::momentum, &LedgerRow::angular,
     "Angular momentum about the origin, with the affine part of APIC."},
    {"kinetic", "J", LedgerGroup::energy, &LedgerRow::kinetic, "Kinetic energy now."},
    {"elastic", "J", LedgerGroup::energy, &LedgerRow::elastic, "Elastic energy now."},
    {"gravity", "J", LedgerGroup::energy, &LedgerRow::gravity, "-m g x now, with the g of that moment."},
    {"work", "J", LedgerGroup::energy, &LedgerRow::work,
     "What force fields and a changing gravity put in since the row before."},
    {"power", "W", LedgerGroup::energy, &LedgerRow::power,
     "The rate at which energy is stored now: by stress, sum V0 tau : grad v, and by gravity, -g times the momentum."},
    {"dissipated", "J", LedgerGroup::energy, &LedgerRow::dissipated,
     "Mechanical energy lost since the row before: -change(kinetic + elastic + gravity) + work + entered_energy."},
    {"dissipated_viscosity", "J", LedgerGroup::losses, &LedgerRow::dissipated_viscosity,
     "Viscous stress times rate of shear; in sub-cycled steps also contact of liquid and solid."},
    {"dissipated_plasticity", "J", LedgerGroup::losses, &LedgerRow::dissipated_plasticity,
     "What the projection of strains gives up. Below 0 where hardening makes the same strain store more, and where "
     "cohesive grains pull while gaps close."},
    {"dissipated_relaxation", "J", LedgerGroup::losses, &LedgerRow::dissipated_relaxation,
     "What volume relaxation and the shift of liquids give up; may be below 0."},
    {"dissipated_friction", "J", LedgerGroup::losses, &LedgerRow::dissipated_friction,
     "Impulses of walls and colliders times the sliding velocity. Below 0 where moving colliders do work."},
    {"dissipated_transfer", "J", LedgerGroup::losses, &LedgerRow::dissipated_transfer,
     "Kinetic energy on the grid that the particles did not take over; for `flip` and `asflip` both ways. Nothing in "
     "steps in which matter left."},
    {"dissipated_damping", "J", LedgerGroup::losses, &LedgerRow::dissipated_damping, "By `time.damping`."},
    {"dissipated_rest", "J", LedgerGroup::losses, &LedgerRow::dissipated_rest,
     "The difference to `dissipated`; it is not measured, and may be below 0 ([below](#what-the-rest-is))."},
    {"wall_impulse", "N s", LedgerGroup::momentum, &LedgerRow::wall_impulse,
     "Momentum from walls and colliders, since the row before."},
    {"wall_angular", "N m s", LedgerGroup::momentum, &LedgerRow::wall_angular,
     "Angular momentum from walls and colliders, since the row before."},
    {"body_impulse", "N s", LedgerGroup::momentum, &LedgerRow::body_impulse,
     "Momentum from gravity, damping and force fields, since the row before."},
    {"body_angular", "N m s", LedgerGroup::momentum, &LedgerRow::body_angular,
     "Angular momentum from these, and from [shifting liquids](../theory/step.md#move)."},
    {"left_momentum", "N s", LedgerGroup::momentum, &LedgerRow::left_momentum,
     "Momentum that leaving matter took along, since the row before."},
    {"left_angular", "N m s", LedgerGroup::momentum, &LedgerRow::left_angular,
     "Angular momentum that leaving matter took along, since the row before."},
    {"momentum_bound", "N s", LedgerGroup::momentum, &LedgerRow::momentum_bound,
     "How far rounding may move the balance of momentum in this row ([below](#bounds))."},
    {"angular_bound", "N m s", LedgerGroup::momentum, &LedgerRow::angular_bound,
     "How far it may move that of angular momentum."},
    {"energy_bound", "J", LedgerGroup::energy, &LedgerRow::energy_bound,
     "How much energy of this row may come from nowhere ([below](#bounds))."},
    {"volume", "m^3", LedgerGroup::volume, &LedgerRow::volume, "Sum of V0 J."},
    {"j_min", "", LedgerGroup::volume, &LedgerRow::j_min, "The least volume ratio J; `nan` in a frame without matter."},
    {"j_max", "", LedgerGroup::volume, &LedgerRow::j_max,
     "The greatest volume ratio J; `nan` in a frame without matter."},
    {"swollen", "", LedgerGroup::volume, &LedgerRow::swollen,
     "The share of their volume at rest that liquids take too much ([below](#swollen-liquid))."},
    {"entered", "", LedgerGroup::mass, &LedgerRow::entered, "Particles that emitters gave since the row before.",
     LedgerRuns::with_emitters},
    {"entered_mass", "kg", LedgerGroup::mass, &LedgerRow::entered_mass, "Mass that emitters gave since the row before.",
     LedgerRuns::with_emitters},
    {"entered_energy", "J", LedgerGroup::energy, &LedgerRow::entered_energy,
     "Energy that emitters gave since the row before.", LedgerRuns::with_emitters},
    {"entered_momentum", "N s", LedgerGroup::momentum, &LedgerRow::entered_momentum,
     "Momentum that emitters gave since the row before.", LedgerRuns::with_emitters},
    {"entered_angular", "N m s", LedgerGroup::momentum, &LedgerRow::entered_angular,
     "Angular momentum that emitters gave since the row before.", LedgerRuns::with_emitters},
    {"dissipated_projection", "J", LedgerGroup::losses, &LedgerRow::dissipated_projection,
     "Kinetic energy on the grid that the pressure took ([below](#by-the-projection)).", LedgerRuns::by_projection},
};

/// The column of a member. A call for a member without one does not compile.
template <class Member>
consteval const LedgerColumn& ledger_column(Member LedgerRow::* member) {
  for (const LedgerColumn& column : ledger_columns)
    if (const auto* value = std::get_if<Member LedgerRow::*>(&column.value); value && *value == member) return column;
  throw "no column shows this member";
}

/// The properties of a run by which its columns are chosen.
struct LedgerKind {
  bool emitters = false, projection = false;

  constexpr bool has(LedgerRuns runs) const {
    return runs == LedgerRuns::all || (runs == LedgerRuns::with_emitters ? emitters : projection);
  }
};

/// One number or word of a row: a column, and of a vector one of its axes.
struct LedgerCell {
  const LedgerColumn* column = nullptr;
  int axis = 0;

  /// Returns the name in the file: `momentum_x`.
  std::string name() const;
};
/// The cells of a run's rows, in their order.
std::vector<LedgerCell> ledger_cells(const LedgerKind& kind);
/// The cell of that name, of any run; one without a column if there is none.
LedgerCell find_ledger_cell(std::string_view name);

/// The number in a cell, by its name. Throws InputError for a name that no number has.
double ledger_number(const LedgerRow& row, std::string_view name);
double& ledger_number(LedgerRow& row, std::string_view name);

}  // namespace dreampm
