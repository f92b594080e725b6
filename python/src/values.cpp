// Plain values: what a step reports, poses and motions, shapes, snapshots.
#include "bindings.h"
#include "convert.h"
#include "dreampm/simulation.h"

#include <nanobind/stl/filesystem.h>

namespace dreampm::python {
namespace {

void bind_reports(nb::module_& m) {
  nb::class_<StepReport> step(m, "StepReport", "What one step did.");
  step.def_ro("step", &StepReport::step, "Steps so far, this one included.")
      .def_ro("time", &StepReport::time, "After the step [s].")
      .def_ro("dt", &StepReport::dt, "Taken [s].")
      .def_ro("limiter", &StepReport::limiter, "What limited dt: speed, wave, viscosity, frame, user.")
      .def_ro("viscous_stages", &StepReport::viscous_stages, "Stages of viscosity in the step; 0: explicit.")
      .def_ro("frame_done", &StepReport::frame_done, "Whether the step ended a frame.")
      .def_ro("max_speed", &StepReport::max_speed, "Of the grid [m/s].")
      .def_ro("j_min", &StepReport::j_min, "The least volume ratio J over all particles [1].")
      .def_ro("j_max", &StepReport::j_max, "The greatest volume ratio J over all particles [1].");
  show(step, "StepReport", {"step", "time", "dt", "limiter", "frame_done", "max_speed", "j_min", "j_max"});

  nb::class_<FrameEvent> frame(m, "FrameEvent", "The end of a frame.");
  frame.def_ro("frame", &FrameEvent::frame, "Whose time is now; frame 1 is the start.")
      .def_ro("time", &FrameEvent::time, "[s]")
      .def_ro("steps", &FrameEvent::steps, "Steps in the frame that ended.");
  show(frame, "FrameEvent", {"frame", "time", "steps"});

  nb::class_<ParticleCounts> counts(m, "ParticleCounts", "Particles that are there, and those that came and went.");
  counts.def_ro("particles", &ParticleCounts::particles, "How many there are.")
      .def_ro("entered", &ParticleCounts::entered, "Particles that `add` and `add_particles` brought, in all.")
      .def_ro("removed", &ParticleCounts::removed, "Particles that `remove` took, in all.")
      .def_ro("left", &ParticleCounts::left, "Particles that left through open walls, in all.")
      .def_ro("drained", &ParticleCounts::drained, "Particles that sinks took, in all.");
  show(counts, "ParticleCounts", {"particles", "entered", "removed", "left", "drained"});

  nb::class_<Totals, ParticleCounts> totals(m, "Totals",
                                            "Sums over all matter, and what edits brought in and took out.");
  totals.def_ro("mass", &Totals::mass, "[kg]")
      .def_ro("momentum", &Totals::momentum, "[kg m/s]")
      .def_ro("kinetic", &Totals::kinetic, "Kinetic energy [J].")
      .def_ro("elastic", &Totals::elastic, "Elastic energy [J].")
      .def_ro("volume", &Totals::volume, "[m^3]")
      .def_ro("entered_mass", &Totals::entered_mass, "[kg]")
      .def_ro("removed_mass", &Totals::removed_mass, "[kg]")
      .def_ro("entered_momentum", &Totals::entered_momentum, "[kg m/s]")
      .def_ro("removed_momentum", &Totals::removed_momentum, "[kg m/s]");
  show(totals, "Totals",
       {"particles", "mass", "momentum", "kinetic", "elastic", "volume", "entered", "removed", "left"});
}

void bind_motion(nb::module_& m) {
  nb::class_<Pose> pose(m, "Pose", "Takes the point p of a shape, as the scene gives it, to position + rotation(p).");
  pose.def_prop_ro(
          "position", [](const Pose& p) { return p.position; }, "[m]")
      .def_prop_ro(
          "rotation",
          [](const Pose& p) { return nb::make_tuple(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z); },
          nb::sig("def rotation(self) -> tuple[float, float, float, float]"), "A unit quaternion (w, x, y, z).")
      .def(
          "__call__", [](const Pose& p, const Vector<"point">& x) { return p(x); }, nb::arg("point"),
          "Where the point of the shape is now [m].");
  show(pose, "Pose", {"position", "rotation"});

  nb::class_<Twist> motion(
      m, "Twist", "How a rigid shape moves: its point x at velocity + spin x (x - center). All zero: at rest.");
  motion
      .def(
          "__init__",
          [](Twist* self, const Vector<"velocity">& velocity, const Vector<"spin">& spin,
             const Vector<"center">& center) { new (self) Twist{velocity, spin, center}; },
          nb::kw_only(), nb::arg("velocity") = Vec3d{}, nb::arg("spin") = Vec3d{}, nb::arg("center") = Vec3d{})
      .def_prop_ro(
          "velocity", [](const Twist& t) { return t.velocity; }, "Of the center [m/s].")
      .def_prop_ro(
          "spin", [](const Twist& t) { return t.spin; }, "[rad/s]")
      .def_prop_ro(
          "center", [](const Twist& t) { return t.center; }, "[m], which moves along.")
      .def(
          "__eq__",
          [](const Twist& a, nb::handle b) { return nb::isinstance<Twist>(b) && a == nb::cast<const Twist&>(b); },
          nb::arg("other"), nb::sig("def __eq__(self, other: object) -> bool"));
  show(motion, "Twist", {"velocity", "spin", "center"});
}

void bind_scene_shapes(nb::module_& m) {
  nb::class_<Shape>(
      m, "Shape",
      "A shape. `box`, `sphere`, `cylinder`, `plane` and `mesh` make one; a | b is both together, a & b what both\n"
      "share, a - b the first without the second. So does any text or dict that may stand behind `shape:` in a\n"
      "scene file, as {'mesh': 'bunny.ply', 'fit': {'longest': 0.3}}.")
      .def(
          "__init__", [](Shape* self, nb::object shape) { new (self) Shape(shape_of(shape)); }, nb::arg("shape"),
          nb::sig("def __init__(self, shape: Shape | dict[str, object] | str) -> None"))
      .def(
          "turned", [](const Shape& s, const Vector<"axis">& axis, double degrees) { return s.turned(axis, degrees); },
          nb::arg("axis"), nb::arg("degrees"), "This shape, turned about its center.")
      .def("__or__", [](const Shape& a, const Shape& b) { return a | b; })
      .def("__and__", [](const Shape& a, const Shape& b) { return a & b; })
      .def("__sub__", [](const Shape& a, const Shape& b) { return a - b; })
      .def("__repr__", [](const Shape& s) { return "Shape('" + shape_yaml(s) + "')"; });
  m.def(
      "box", [](const Vector<"min">& min, const Vector<"max">& max) { return Shape::box(min, max); }, nb::arg("min"),
      nb::arg("max"), "A box between two corners [m].");
  m.def(
      "sphere", [](const Vector<"center">& center, double radius) { return Shape::sphere(center, radius); },
      nb::arg("center"), nb::arg("radius"), "A ball [m].");
  m.def(
      "cylinder",
      [](const Vector<"center">& center, double radius, double height) {
        return Shape::cylinder(center, radius, height);
      },
      nb::arg("center"), nb::arg("radius"), nb::arg("height"), "An upright cylinder [m].");
  m.def(
      "plane", [](const Vector<"point">& point, const Vector<"normal">& normal) { return Shape::plane(point, normal); },
      nb::arg("point"), nb::arg("normal"), "All that is behind a plane [m], whose normal points out of it.");
  m.def(
      "mesh",
      [](const std::filesystem::path& file, std::optional<double> longest,
         const std::optional<Vector<"center">>& center) {
        Shape shape = Shape::mesh(file.string());
        std::get<MeshShape>(shape.form).longest = longest, shape.center = given(center);
        return shape;
      },
      nb::arg("file"), nb::kw_only(), nb::arg("longest") = nb::none(), nb::arg("center") = nb::none(),
      nb::sig(
          "def mesh(file: str | os.PathLike[str], *, longest: float | None = None, center: numpy.typing.ArrayLike | "
          "None = None) -> Shape"),
      "A mesh file (PLY, STL, OBJ, OFF, glTF, or asset:NAME), scaled so that its longest side is `longest` [m], its\n"
      "middle at `center` [m]; without them as the file has it.");
}

}  // namespace

void bind_values(nb::module_& m) {
  bind_reports(m);
  bind_motion(m);
  bind_scene_shapes(m);
  nb::class_<Snapshot> snapshot(m, "Snapshot",
                                "The whole state of a simulation in memory, which Simulation.snapshot gives.");
  snapshot.def_prop_ro("time", &Snapshot::time, "[s]").def_prop_ro("bytes", &Snapshot::bytes, "Of memory, about.");
  show(snapshot, "Snapshot", {"time", "bytes"});
}

}  // namespace dreampm::python
