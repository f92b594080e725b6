// Rigid bodies and colliders that come and go, and hands that hold bodies.
#include "bindings.h"
#include "convert.h"
#include "held.h"

namespace dreampm::python {
namespace {

using Held = HeldSimulation;

std::string look_text(nb::handle look) { return look.is_none() ? std::string() : yaml_of(look); }

void add_rigid(Held& held, std::string name, nb::handle shape, double density,
               const std::optional<Vector<"position">>& position, const Vector<"velocity">& velocity,
               const Vector<"spin">& spin, double friction, double restitution, nb::handle look) {
  const NewRigid body{std::move(name), shape_of(shape), density,        given(position), velocity, spin,
                      friction,        restitution,     look_text(look)};
  held.call([&](Simulation& s) { s.add_rigid(body); });
}

void add_collider(Held& held, std::string name, nb::handle shape, std::string type, double friction, nb::handle look) {
  const NewCollider collider{std::move(name), shape_of(shape), std::move(type), friction, look_text(look)};
  held.call([&](Simulation& s) { s.add_collider(collider); });
}

}  // namespace

void bind_collider_edits(nb::class_<HeldSimulation>& c) {
  const NewRigid body{"", SceneShape::yaml("")};
  c.def("add_rigid", add_rigid, nb::arg("name"), nb::arg("shape"), nb::kw_only(), nb::arg("density") = body.density,
        nb::arg("position") = nb::none(), nb::arg("velocity") = Vec3d{}, nb::arg("spin") = Vec3d{},
        nb::arg("friction") = body.friction, nb::arg("restitution") = body.restitution, nb::arg("look") = nb::none(),
        nb::sig("def add_rigid(self, name: str, shape: Shape | dict[str, object] | str, *, density: float = 1000, "
                "position: numpy.typing.ArrayLike | None = None, velocity: numpy.typing.ArrayLike = (0, 0, 0), "
                "spin: numpy.typing.ArrayLike = (0, 0, 0), friction: float = 0.4, restitution: float = 0, "
                "look: dict[str, object] | str | None = None) -> None"),
        "A rigid body that falls, floats and meets the others from the next step on. name: not yet in use;\n"
        "density [kg/m^3], 0.1 to 30000; position [m] of the middle of its shape, None: where the shape says;\n"
        "velocity [m/s]; spin [rad/s] about its center of mass; friction: 0 to 100; restitution: 0 to 1; look: as\n"
        "in a scene's render.looks. Refuses one that reaches outside of walls, or into matter or other bodies.")
      .def(
          "remove_rigid",
          [](Held& h, const std::string& name) { h.call([&](Simulation& s) { s.remove_rigid(name); }); },
          nb::arg("name"), "Takes a rigid body out.")
      .def(
          "hold",
          [](Held& h, const std::string& name, const Vector<"at">& at, const Vector<"to">& to, double stiffness,
             double damping) {
            const Grip grip{at, to, stiffness, damping};
            h.call([&](Simulation& s) { s.hold(name, grip); });
          },
          nb::arg("name"), nb::kw_only(), nb::arg("at"), nb::arg("to"), nb::arg("stiffness"), nb::arg("damping") = 0.0,
          "Draws the point `at` [m] of a rigid body, of its shape as the scene gives it, to `to` [m] by a spring of\n"
          "`stiffness` [N/m] and `damping` [N s/m], until another hold of that body or `let_go`.")
      .def(
          "let_go",
          [](Held& h, const std::optional<std::string>& name) {
            h.call([&](Simulation& s) { name ? s.let_go(*name) : s.let_go(); });
          },
          nb::arg("name") = nb::none(), "Of all bodies without a name. Nothing happens where the body is not held.")
      .def("add_collider", add_collider, nb::arg("name"), nb::arg("shape"), nb::kw_only(), nb::arg("type") = "separate",
           nb::arg("friction") = 0.0, nb::arg("look") = nb::none(),
           nb::sig("def add_collider(self, name: str, shape: Shape | dict[str, object] | str, *, "
                   "type: str = 'separate', friction: float = 0, look: dict[str, object] | str | None = None) -> None"),
           "A collider that stands until `colliders[name].motion` is set. type: separate, slip or stick; friction: 0\n"
           "to 100. Refuses one in matter or rigid bodies.")
      .def(
          "remove_collider",
          [](Held& h, const std::string& name) { h.call([&](Simulation& s) { s.remove_collider(name); }); },
          nb::arg("name"), "Takes a collider out.")
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
