// Rigid bodies and colliders that come and go, and springs that hold bodies.
#include "bindings.h"
#include "convert.h"
#include "held.h"
#include "model_members.h"

namespace dreampm::python {
namespace {

using Held = HeldSimulation;

void add_collider(Held& held, const Record<model::Collider>& collider, const std::optional<Record<model::Look>>& look) {
  const model::Collider given = value_of(collider);
  const std::optional<model::Look> looks = look ? std::optional(value_of(*look)) : std::nullopt;
  held.call([&](Simulation& s) { s.add(given, looks); });
}

}  // namespace

void bind_collider_edits(nb::class_<HeldSimulation>& c) {
  c.def("add", add_collider, nb::arg("collider"), nb::kw_only(), nb::arg("look") = nb::none(),
        nb::sig("def add(self, collider: model.Collider, *, look: model.Look | None = None) -> None"),
        "A collider more. A rigid body falls, floats and meets the others from the next step on; others stand until\n"
        "`colliders[name].motion` is set. Refuses one in matter, and a rigid body that reaches outside of walls or\n"
        "into others.")
      .def(
          "attach",
          [](Held& h, const std::string& name, const Vector<"at">& at, const Vector<"to">& to, double stiffness,
             double damping) {
            const SpringAnchor anchor{at, to, stiffness, damping};
            h.call([&](Simulation& s) { s.attach(name, anchor); });
          },
          nb::arg("name"), nb::kw_only(), nb::arg("at"), nb::arg("to"), nb::arg("stiffness"), nb::arg("damping") = 0.0,
          "Draws the point `at` [m] of a rigid body, of its shape as the scene gives it, to `to` [m] by a spring of\n"
          "`stiffness` [N/m] and `damping` [N s/m], until it is attached elsewhere or `detach`.")
      .def(
          "detach",
          [](Held& h, const std::optional<std::string>& name) {
            h.call([&](Simulation& s) { name ? s.detach(*name) : s.detach(); });
          },
          nb::arg("name") = nb::none(), "Of all bodies without a name. Nothing happens where the body is not held.")
      .def(
          "remove_collider",
          [](Held& h, const std::string& name) { h.call([&](Simulation& s) { s.remove_collider(name); }); },
          nb::arg("name"), "Takes a collider or a rigid body out.")
      .def(
          "convert",
          [](Held& h, const std::string& from, const std::string& to) {
            return h.call([&](Simulation& s) { return s.convert(from, to); });
          },
          nb::arg("source"), nb::arg("target"),
          "All particles of one material become another's: places, velocities and ids stay, the deformation is\n"
          "forgotten. Returns how many.");
}

}  // namespace dreampm::python
