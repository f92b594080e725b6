// The one list of what a World, a ParticleSet and a GridFields hold. Copy, hash, checkpoint, sort
// and passes walk over it. Each list binds all members by a structured binding, so a member that is
// not in the list does not compile.
#pragma once
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "dreampm/state/world.h"

namespace dreampm {

/// The uses of a member.
struct FieldUse {
  bool copied = false;   ///< by as_world: what a scene gives before there is matter
  bool hashed = false;   ///< by state_hash: it decides the future
  bool saved = false;    ///< by a checkpoint
  bool carried = false;  ///< by a sort: it moves with the particles, or with the blocks of the grid
  /// A number counts for hash and checkpoint only where it is not the default; an array is saved
  /// only where it is there. For members that came after files and hashes existed.
  bool sparse = false;
};

namespace field_use {
/// A scene gives it.
inline constexpr FieldUse setup{.copied = true, .hashed = true};
/// A scene gives it, and results do not depend on it.
inline constexpr FieldUse setup_unhashed{.copied = true};
/// A scene gives it, and a run may change it.
inline constexpr FieldUse setup_and_state{.copied = true, .hashed = true, .saved = true};
/// Steps change it.
inline constexpr FieldUse state{.hashed = true, .saved = true};
/// A column of particles, or nodes of the grid.
inline constexpr FieldUse column{.hashed = true, .saved = true, .carried = true};
/// A member for the ledger: it does not decide the future, but a run that goes on reports the same.
inline constexpr FieldUse reported{.saved = true};
/// Every step finds it anew.
inline constexpr FieldUse not_state{};
constexpr FieldUse sparse(FieldUse use) {
  use.sparse = true;
  return use;
}
}  // namespace field_use

/// An array is there in every world.
struct Always {
  template <class Owner>
  constexpr bool operator()(const Owner&) const {
    return true;
  }
};

/// A list's entry for a member. `name` is also the member's name in a checkpoint.
template <FieldUse of, class Needed = Always>
struct Field {
  static constexpr FieldUse use = of;
  std::string_view name;
  /// Predicate: true if the array has to be there. It takes a World for the grid's fields, a
  /// ParticleSet for columns.
  Needed needed{};
};

template <class F, class T>
struct FieldEntry {
  F field;
  T& value;
};
template <FieldUse use, class T>
auto entry(std::string_view name, T& value) {
  return FieldEntry<Field<use>, T>{{name}, value};
}
template <FieldUse use, class T, class Needed>
auto entry(std::string_view name, T& value, const Needed& needed) {
  return FieldEntry<Field<use, Needed>, T>{{name, needed}, value};
}

template <class T, template <class> class Of>
inline constexpr bool is_of = false;
template <class R, template <class> class Of>
inline constexpr bool is_of<Of<R>, Of> = true;
template <class T, template <class> class Of>
concept MaybeConst = is_of<std::remove_const_t<T>, Of>;

/// All of a World, in the order in which state_hash takes them. `W`: World<R>, const or not; so
/// below.
template <MaybeConst<World> W>
auto fields_of(W& world) {
  using namespace field_use;
  auto& [step, frame, time, dt_next, dt_limiter, kept_for, viscous_stages, dx, origin, low, high, walls, periodic,
         gravity, gravity_keys, fields, settings, sets, particle_blocks, grid, colliders, rigid, collision, emitters,
         sinks, emitted_until, arrivals, next_id, drift, wave_speed, viscosity, kept_kinetic_energy, left,
         scatter_bounds, node_speed, dt_before, cell_pressure] = world;
  auto& [solver, fps, cfl, fixed_dt, dt_max, sub_cycles, damping, keep_inside, surface_contact] = settings;
  return std::tuple{entry<state>("step", step),
                    entry<state>("frame", frame),
                    entry<state>("time", time),
                    entry<state>("dt_next", dt_next),
                    entry<state>("dt_limiter", dt_limiter),
                    entry<sparse(state)>("kept_for", kept_for),
                    entry<sparse(state)>("viscous_stages", viscous_stages),
                    entry<sparse(setup)>("solver", solver),
                    entry<sparse(setup)>("sub_cycles", sub_cycles),
                    entry<setup>("dx", dx),
                    entry<setup_unhashed>("origin", origin),
                    entry<setup_unhashed>("low", low),
                    entry<setup>("high", high),
                    entry<setup>("walls", walls),
                    entry<setup>("periodic", periodic),
                    entry<setup>("gravity", gravity),
                    entry<setup>("gravity_keys", gravity_keys),
                    entry<setup>("fields", fields),
                    entry<setup>("fps", fps),
                    entry<setup_and_state>("cfl", cfl),
                    entry<setup>("fixed_dt", fixed_dt),
                    entry<setup>("dt_max", dt_max),
                    entry<setup>("damping", damping),
                    entry<setup>("keep_inside", keep_inside),
                    entry<sparse(setup)>("surface_contact", surface_contact),
                    entry<state>("drift", drift),
                    entry<state>("wave_speed", wave_speed),
                    entry<state>("viscosity", viscosity),
                    entry<sparse(reported)>("keeping", kept_kinetic_energy),
                    entry<state>("left", left),
                    entry<sparse(state)>("scatter_bounds", scatter_bounds),
                    entry<setup_and_state>("colliders", colliders),
                    entry<setup>("rigid", rigid),
                    entry<setup_unhashed>("collision", collision),
                    entry<setup_and_state>("emitters", emitters),
                    entry<setup_and_state>("sinks", sinks),
                    entry<sparse(state)>("emitted_until", emitted_until),
                    entry<sparse(reported)>("arrivals", arrivals),
                    entry<sparse(setup_and_state)>("next_id", next_id),
                    entry<state>("particle_blocks", particle_blocks),
                    entry<setup_and_state>("set", sets),
                    entry<state>("grid", grid),
                    entry<sparse(state)>("dt_before", dt_before),
                    entry<sparse(state)>("cell_pressure", cell_pressure),
                    entry<not_state>("node_speed", node_speed)};
}

/// All of a ParticleSet.
template <MaybeConst<ParticleSet> S>
auto fields_of(S& set) {
  using namespace field_use;
  auto& [name, material, values, liquid, mass, rest_volume, transfer, carries_motion, id, u, columns, own_velocity,
         gradient, block_start] = set;
  return std::tuple{entry<setup>("name", name),
                    entry<setup>("material", material),
                    entry<setup>("values", values),
                    entry<setup_unhashed>("liquid", liquid),  // the material says it
                    entry<setup>("mass", mass),
                    entry<setup>("rest_volume", rest_volume),
                    entry<setup>("transfer", transfer),
                    entry<setup_unhashed>("carries_motion", carries_motion),  // the world's solver says it
                    entry<column>("id", id),
                    entry<state>("block_start", block_start),
                    entry<column>("u", u),
                    entry<column>("state", columns),
                    entry<sparse(column)>("own", own_velocity, [](const auto& s) { return s.has_own_velocity(); }),
                    entry<sparse(column)>("gradient", gradient, [](const auto& s) { return s.carries_motion; })};
}

/// All of a GridFields. `needed` of its node arrays asks the World.
template <MaybeConst<GridFields> G>
auto fields_of(G& grid) {
  using namespace field_use;
  auto& [blocks, nodes, solids, mixture, velocity_old, stress] = grid;
  return std::tuple{
      entry<state>("blocks", blocks),
      entry<column>("nodes", nodes, [](const auto& w) { return w.settings.solver == SolverKind::explicit_steps; }),
      entry<column>("solids", solids, [](const auto& w) { return w.needs_solid_field(); }),
      entry<column>("mixture", mixture, [](const auto& w) { return w.needs_mixture(); }),
      entry<sparse(column)>("before0", velocity_old[0], [](const auto& w) { return w.keeps_velocities(0); }),
      entry<sparse(column)>("before1", velocity_old[1], [](const auto& w) { return w.keeps_velocities(1); }),
      // A sort within a step comes after the grid's update, which is the last that reads them.
      entry<sparse(state)>("stress0", stress[0], [](const auto& w) { return w.viscous_stages > 0; }),
      entry<sparse(state)>("stress1", stress[1],
                           [](const auto& w) { return w.viscous_stages > 0 && w.needs_solid_field(); })};
}

/// Calls f(column) for every array of numbers in a member that is one of the columns of a
/// ParticleSet.
template <class Member, class F>
void visit_columns(Member& member, const F& f) {
  if constexpr (std::is_arithmetic_v<typename Member::value_type>)
    f(member);
  else
    for (auto& one : member) f(one);
}

/// Calls f(field, member) for all members of a World, a ParticleSet or a GridFields; `field` is a
/// Field<use, needed>.
template <class Owner, class F>
void visit_fields(Owner& owner, F&& f) {
  std::apply([&](const auto&... e) { (f(e.field, e.value), ...); }, fields_of(owner));
}
/// Calls f(field, member of a, member of b).
template <class A, class B, class F>
void visit_fields(A& a, B& b, F&& f) {
  const auto first = fields_of(a);
  const auto second = fields_of(b);
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (f(std::get<i>(first).field, std::get<i>(first).value, std::get<i>(second).value), ...);
  }(std::make_index_sequence<std::tuple_size_v<decltype(fields_of(a))>>());
}

/// The same for the arrays of nodes alone.
template <MaybeConst<GridFields> G, class F>
void visit_nodes(G& grid, F&& f) {
  visit_fields(grid, [&](const auto& field, auto& nodes) {
    if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(nodes)>, BlockList>) f(field, nodes);
  });
}
template <MaybeConst<GridFields> A, MaybeConst<GridFields> B, class F>
void visit_nodes(A& a, B& b, F&& f) {
  visit_fields(a, b, [&](const auto& field, auto& first, auto& second) {
    if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(first)>, BlockList>) f(field, first, second);
  });
}

}  // namespace dreampm
