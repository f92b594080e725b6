#include "dreampm/simulation.h"

#include <nanobind/stl/filesystem.h>

#include "bindings.h"
#include "dreampm/base/hash.h"
#include "dreampm/render.h"
#include "held.h"
#include "matter.h"
#include "model_members.h"
#include "parts.h"

namespace dreampm::python {
namespace {

using Held = HeldSimulation;

/// Steps frame by frame.
struct Frames : PartOf {
  int count = 0, done = 0;

  FrameEvent next() {
    if (done >= count) throw nb::stop_iteration();
    const FrameEvent event = held().advance([](Simulation& s) {
      const std::uint64_t before = s.steps();
      s.advance_frames(1);
      return FrameEvent{s.frame(), s.time(), s.steps() - before};
    });
    ++done;
    return event;
  }
};

Frames frames(nb::object simulation, std::optional<int> count) {
  auto& held = nb::cast<Held&>(simulation);
  const int left = held.look([](const Simulation& s) { return s.scene().frames() - s.frame(); });
  if (count && *count < 0) throw InputError("frames: " + std::to_string(*count) + " frames: must be 0 or more");
  return {{std::move(simulation)}, count.value_or(std::max(0, left))};
}

/// Returns the state hash as the records of runs have it.
std::string hex_of(std::uint64_t state) {
  Hash64 hash;
  hash.add(state);
  return hash.hex();
}

template <class Part>
Part part_of(nb::object simulation) {
  return {{std::move(simulation)}};
}

/// The three rows of each matrix of an array (n, 3, 3).
std::vector<Vec3d> rows_of(nb::handle matrices, const char* name) {
  const nb::object array = nb::module_::import_("numpy").attr("asarray")(matrices, "float64");
  if (!nb::cast<bool>(array.attr("shape")[nb::slice(1, 3)].attr("__eq__")(nb::make_tuple(3, 3))))
    throw nb::type_error((std::string(name) + ": shape " + nb::cast<std::string>(nb::repr(array.attr("shape"))) +
                          ": matrices are of shape (n, 3, 3)")
                             .c_str());
  return points_of(array.attr("reshape")(-1, 3), name);
}

void add_particles(Held& held, const std::string& material, nb::handle positions, const Vector<"velocity">& velocity,
                   nb::handle velocities, nb::handle gradients) {
  const std::vector<Vec3d> places = points_of(positions, "positions");
  const Vec3d one = velocity;
  const std::vector<Vec3d> each = velocities.is_none() ? std::vector(places.size(), one)
                                                       : points_of(velocities, "velocities"),
                           rows = gradients.is_none() ? std::vector(3 * places.size(), Vec3d{})
                                                      : rows_of(gradients, "gradients");
  if (each.size() != places.size() || rows.size() != 3 * places.size())
    throw InputError("add_particles: " + std::to_string(places.size()) + " positions, " + std::to_string(each.size()) +
                     " velocities and " + std::to_string(rows.size() / 3) + " gradients: must be as many");
  std::vector<NewParticle> particles;
  for (std::size_t i = 0; i < places.size(); ++i)
    particles.push_back({places[i], each[i], {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]}});
  held.call([&](Simulation& s) { s.add_particles(material, particles); });
}

TriMesh surface(Held& held, const std::optional<std::string>& material, double voxel, int smooth, double overlap) {
  const std::vector<std::string> names = held.look([](const Simulation& s) { return s.scene().materials(); });
  if (!material && names.size() != 1) throw InputError("surface: the scene has several materials: name one");
  return held.call([&](Simulation& s) { return s.surface(material.value_or(names[0]), {voxel, smooth, overlap}); });
}

Picture picture(Held& held, std::optional<int> width, std::optional<int> height, std::optional<int> samples) {
  return array_of(held.call([&](Simulation& s) { return render(s, {width, height, samples}); }));
}

Picture first_picture(const Scene& scene, std::optional<int> width, std::optional<int> height,
                      std::optional<int> samples) {
  Held start(scene, "cpu", "auto", 0);
  return picture(start, width, height, samples);
}

constexpr const char* about_simulation =
    "A scene that runs in this program.\n\n"
    "    sim = dreampm.Simulation(dreampm.Scene.load('dam-break.yaml', variant='preview'))\n"
    "    for frame in sim.frames(48):\n"
    "        x = sim.particles['water'].position      # numpy, float32 (n, 3) [m]\n"
    "    sim.materials['water'].viscosity = 8.5       # honey from now on\n\n"
    "Time moves by whole steps, whose length the solver chooses; the last step of a frame ends exactly\n"
    "at the frame's time. The same calls give the same bits, for any number of threads, after `restore`,\n"
    "and in the command `dreampm run`. SI units, y up.\n\n"
    "Edits act from the next step on: particles keep positions, velocities and deformation. They may stand\n"
    "between steps and inside of observers. What they refuse is an InputError, as in a scene file.\n\n"
    "While it steps the GIL is free: other threads of Python run. A simulation is used by one thread at a\n"
    "time (another one gets RunError); several simulations may run side by side. Ctrl-C is asked for between\n"
    "steps: KeyboardInterrupt leaves the call after a whole step, and the simulation can go on.";

constexpr const char* about_init =
    "Fills the bodies with particles.\n\n"
    "backend:  'cpu': fast, in float; 'reference': plain loops, in double; 'cuda': particles on an NVIDIA GPU.\n"
    "isa:      instruction set of the cpu backend, which decides the bits; 'auto': the best one.\n"
    "threads:  that a step uses at most; 0: all cores. Bits do not depend on it.";

void bind_time(nb::class_<Held>& c) {
  c.def(
       "step", [](Held& h) { return h.advance([](Simulation& s) { return s.step(); }); },
       "One step. Raises NumericalFailure where the numbers stop being numbers.")
      .def(
          "advance_to", [](Held& h, double time) { h.advance([&](Simulation& s) { s.advance_to(time); }); },
          nb::arg("time"),
          "Steps until the time [s] is reached, which the last step may pass by less than its length. No step is\n"
          "taken where it has passed: `restore` goes back. Raises InputError for a time that is not a finite number.")
      .def(
          "advance_frames", [](Held& h, int n) { h.advance([&](Simulation& s) { s.advance_frames(n); }); },
          nb::arg("count"), "Steps to the end of that many frames.")
      .def(
          "advance_steps",
          [](Held& h, int n, bool goes_on) {
            const ForceMean mean = goes_on ? ForceMean::goes_on : ForceMean::of_this_call;
            return h.advance([&](Simulation& s) { return s.advance_steps(n, mean); });
          },
          nb::arg("count"), nb::kw_only(), nb::arg("goes_on") = false,
          "That many steps, at least one: faster than as many calls of `step`. goes_on: forces on colliders are means\n"
          "over the steps of the call before, too.")
      .def(
          "frames", [](nb::handle self, std::optional<int> n) { return frames(nb::borrow(self), n); },
          nb::arg("count") = nb::none(),
          "Steps frame by frame: an iterator of FrameEvent, of that many frames, else of those that the scene has\n"
          "left. It has a len(), so that tqdm knows the end.")
      .def_prop_ro(
          "time", [](Held& h) { return h.look([](const Simulation& s) { return s.time(); }); }, "[s]")
      .def_prop_ro(
          "frame", [](Held& h) { return h.look([](const Simulation& s) { return s.frame(); }); }, "1 at the start.")
      .def_prop_ro(
          "steps", [](Held& h) { return h.look([](const Simulation& s) { return s.steps(); }); }, "So far.")
      .def_prop_ro(
          "dt", [](Held& h) { return h.call([](Simulation& s) { return s.dt(); }); }, "Of the step to come [s].")
      .def(
          "on_step",
          [](Held& h, nb::callable f) {
            h.on_step(f);
            return f;
          },
          nb::arg("observer"),
          nb::sig("def on_step(self, observer: collections.abc.Callable[[StepReport], object]) -> "
                  "collections.abc.Callable[[StepReport], object]"),
          "Calls observer(StepReport) after every step; returns it, so that this is a decorator too. What it\n"
          "raises leaves the call that steps, after the step is whole.")
      .def(
          "on_frame",
          [](Held& h, nb::callable f) {
            h.on_frame(f);
            return f;
          },
          nb::arg("observer"),
          nb::sig("def on_frame(self, observer: collections.abc.Callable[[FrameEvent], object]) -> "
                  "collections.abc.Callable[[FrameEvent], object]"),
          "The same, with FrameEvent, where a frame ends.");
}

void bind_state(nb::class_<Held>& c) {
  c.def_prop_ro(
       "scene", [](Held& h) { return h.look([](const Simulation& s) { return s.scene(); }); },
       "The Scene, with all edits of parameters so far.")
      .def_prop_ro("particle_count",
                   [](Held& h) { return h.look([](const Simulation& s) { return s.particle_count(); }); })
      .def_prop_ro(
          "particles", [](nb::handle self) { return part_of<ParticleSets>(nb::borrow(self)); },
          "By material: sim.particles['water'].position is float32 (n, 3) [m].")
      .def_prop_ro(
          "materials", [](nb::handle self) { return part_of<Materials>(nb::borrow(self)); },
          "By name: sim.materials['water'].viscosity = 0.1.")
      .def_prop_ro(
          "walls", [](nb::handle self) { return part_of<Walls>(nb::borrow(self)); },
          "By name: sim.walls['x_max'] = 'open'.")
      .def_prop_ro(
          "colliders", [](nb::handle self) { return part_of<Colliders>(nb::borrow(self)); },
          "By name: sim.colliders['gate'].motion = Motion(velocity=(0, 1, 0)).")
      .def_prop_ro(
          "probes", [](nb::handle self) { return part_of<Probes>(nb::borrow(self)); },
          "By name: sim.probes['level']['height'], at sim.probes['level']['time'].")
      .def_prop_rw(
          "gravity", [](Held& h) { return h.look([](const Simulation& s) { return s.gravity(); }); },
          [](Held& h, const Vector<"gravity">& gravity) {
            const Vec3d g = gravity;
            h.call([&](Simulation& s) { s.set_gravity(g); });
          },
          "[m/s^2], now. What is set replaces keyframes.")
      .def_prop_ro(
          "totals", [](Held& h) { return h.call([](Simulation& s) { return s.totals(); }); },
          "Mass, momentum, energies: sums over all matter as it stands.")
      .def(
          "hash", [](Held& h) { return hex_of(h.call([](Simulation& s) { return s.hash(); })); },
          "Every bit that decides the future: 16 hexadecimal digits, the state_hash of `dreampm info`.")
      .def(
          "snapshot", [](Held& h) { return h.call([](Simulation& s) { return s.snapshot(); }); },
          "The whole state in memory, for `restore`.")
      .def(
          "restore", [](Held& h, const Snapshot& then) { h.call([&](Simulation& s) { s.restore(then); }); },
          nb::arg("snapshot"),
          "Goes back to a snapshot of a simulation of the same scene. Of another backend of the same precision,\n"
          "cpu or cuda, it goes on to rounding; of another precision it raises InputError.")
      .def(
          "save", [](Held& h, const std::filesystem::path& file) { h.call([&](Simulation& s) { s.save(file); }); },
          nb::arg("file"), nb::sig("def save(self, file: str | os.PathLike[str]) -> None"),
          "Writes this moment as a scene that goes on from it: FILE, which must end in .yaml, and beside it the same\n"
          "name with .start.h5, which holds all matter. Simulation(Scene.load(FILE)) has the same future to the bit,\n"
          "with the same backend and instruction set. Bodies have lost their names and colors; brushes are\n"
          "fields of that scene. Not in it: observers, what probes have measured, and the springs of `attach`.")
      .def("surface", surface, nb::arg("material") = nb::none(), nb::kw_only(),
           nb::arg("voxel") = SurfaceOptions().voxel, nb::arg("smooth") = SurfaceOptions().smooth,
           nb::arg("overlap") = SurfaceOptions().overlap,
           "The surface of a material's particles as a Mesh; the only material needs no name. voxel: edge of a\n"
           "voxel over that of a cell, 1/16 to 1 at 8 particles a cell; smooth: rounds of smoothing, 0 to 10;\n"
           "overlap: spacings that it reaches into walls and colliders that it touches, 0 to 1.")
      .def("render", picture, nb::kw_only(), nb::arg("width") = nb::none(), nb::arg("height") = nb::none(),
           nb::arg("samples") = nb::none(), "The same as dreampm.render(sim).");
}

void bind_edits(nb::class_<Held>& c) {
  c.def(
       "add",
       [](Held& h, const Record<model::Body>& body) {
         const model::Body given = value_of(body);
         h.call([&](Simulation& s) { s.add(given); });
       },
       nb::arg("body"), nb::sig("def add(self, body: model.Body) -> None"),
       "Fills a shape with a material of the scene. Refuses a name in use, and a body that reaches outside of walls\n"
       "or into colliders.")
      .def("add_particles", add_particles, nb::arg("material"), nb::arg("positions"), nb::kw_only(),
           nb::arg("velocity") = Vec3d{}, nb::arg("velocities") = nb::none(), nb::arg("gradients") = nb::none(),
           nb::sig("def add_particles(self, material: str, positions: numpy.typing.ArrayLike, *, velocity: "
                   "numpy.typing.ArrayLike = (0, 0, 0), velocities: numpy.typing.ArrayLike | None = None, "
                   "gradients: numpy.typing.ArrayLike | None = None) -> None"),
           "Particles of a material at these places, (n, 3) [m], all at one velocity [m/s], undeformed; or each with\n"
           "its own of `velocities`, (n, 3), and its velocity gradient, (n, 3, 3) [1/s]: row a is that of component a\n"
           "along x, y, z. Where matter is already it is there twice. Refuses a place outside of the walls, and adds\n"
           "none then.")
      .def(
          "remove",
          [](Held& h, nb::handle region) {
            const Shape shape = shape_of(region);
            return h.call([&](Simulation& s) { return s.remove(shape); });
          },
          nb::arg("region"), nb::sig("def remove(self, region: Shape | dict[str, object] | str) -> int"),
          "Takes out all particles whose centers lie inside; returns how many.")
      .def(
          "add_material",
          [](Held& h, const Record<model::Material>& material, const std::optional<Record<model::Look>>& look) {
            const model::Material given = value_of(material);
            const std::optional<model::Look> looks = look ? std::optional(value_of(*look)) : std::nullopt;
            h.call([&](Simulation& s) { s.add_material(given, looks); });
          },
          nb::arg("material"), nb::kw_only(), nb::arg("look") = nb::none(),
          nb::sig("def add_material(self, material: model.Material, *, look: model.Look | None = None) -> None"),
          "A material more, of which there is no particle yet.")
      .def(
          "set_brush",
          [](Held& h, const std::string& name, const Record<VelocityBrush>& stroke) {
            const VelocityBrush given = value_of(stroke);
            h.call([&](Simulation& s) { s.set_brush(name, given); });
          },
          nb::arg("name"), nb::arg("stroke"),
          "Takes matter along until another stroke of the same name, or `remove_brush`.")
      .def(
          "remove_brush",
          [](Held& h, const std::string& name) { h.call([&](Simulation& s) { s.remove_brush(name); }); },
          nb::arg("name"), "Nothing happens where there is no such brush.");
}

}  // namespace

void bind_simulation(nb::module_& m) {
  nb::class_<Held> c(m, "Simulation", about_simulation, nb::type_slots(simulation_slots));
  c.def(
      "__init__",
      [](Held* self, nb::handle scene, std::string backend, std::string isa, int threads) {
        if (!nb::isinstance<Scene>(scene))
          throw nb::type_error("Simulation(scene): a Scene; Scene.load('FILE.yaml') reads one from a file");
        new (self) Held(nb::cast<const Scene&>(scene), std::move(backend), std::move(isa), threads);
      },
      nb::arg("scene"), nb::kw_only(), nb::arg("backend") = "cpu", nb::arg("isa") = "auto", nb::arg("threads") = 0,
      nb::sig("def __init__(self, scene: Scene, *, backend: str = 'cpu', isa: str = 'auto', threads: int = 0) -> None"),
      about_init);
  bind_time(c);
  bind_state(c);
  bind_edits(c);
  bind_collider_edits(c);
  bind_reads_of(c);
  c.def("__repr__", [](nb::handle self) {
    return shown(self, "Simulation", {"scene", "time", "frame", "steps", "particle_count"});
  });

  nb::class_<Frames>(m, "Frames", "Steps a simulation frame by frame.", nb::type_slots(part_slots))
      .def(
          "__iter__", [](nb::handle self) { return nb::borrow(self); }, nb::sig("def __iter__(self) -> Frames"))
      .def("__next__", &Frames::next)
      .def("__len__", [](const Frames& f) { return f.count; });

  m.def("render", first_picture, nb::arg("scene"), nb::kw_only(), nb::arg("width") = nb::none(),
        nb::arg("height") = nb::none(), nb::arg("samples") = nb::none(), "The same of a scene at its start.");
  m.def("render", picture, nb::arg("simulation"), nb::kw_only(), nb::arg("width") = nb::none(),
        nb::arg("height") = nb::none(), nb::arg("samples") = nb::none(),
        "A picture of a simulation as it stands, by the path tracer of `dreampm render`: uint8 (height, width, 3),\n"
        "sRGB, rows from the top. width, height: pixels, 8 to 16384; samples: at most, a pixel, 4 or more. What is\n"
        "not given is as the scene's section `render` says.");
}

}  // namespace dreampm::python
