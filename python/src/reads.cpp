// The read side of a simulation: names, sums, attributes of particles, shapes, rays.
#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>

#include "bindings.h"
#include "convert.h"
#include "dreampm/queries.h"
#include "held.h"
#include "structs.h"

namespace dreampm::python {
namespace {

using Held = HeldSimulation;

void bind_names(nb::module_& m) {
  nb::class_<Names> c(m, "Names", "What there is in a simulation, in the order of its scene.");
  c.def_ro("materials", &Names::materials)
      .def_ro("bodies", &Names::bodies, "Of matter.")
      .def_ro("colliders", &Names::colliders, "Rigid bodies too.")
      .def_ro("rigid", &Names::rigid, "Rigid bodies alone.")
      .def_ro("emitters", &Names::emitters)
      .def_ro("sinks", &Names::sinks)
      .def_ro("probes", &Names::probes)
      .def_ro("fields", &Names::fields, "Of force.")
      .def_ro("brushes", &Names::brushes, "That are down.");
  show(c, "Names", {"materials", "bodies", "colliders", "rigid", "emitters", "sinks", "probes", "fields", "brushes"});
}

void bind_states(nb::module_& m) {
  nb::class_<Stepping> steps(m, "Stepping", "What the length of steps goes by.");
  steps.def_ro("solver", &Stepping::solver, "explicit or projection.")
      .def_ro("cell", &Stepping::cell, "Edge of a cell of the grid [m].")
      .def_ro("cfl", &Stepping::cfl, "Cells that sound or matter may cross in a step.")
      .def_ro("dt_max", &Stepping::dt_max, "The longest step that the scene allows [s]; 1e30: any.")
      .def_ro("fixed_dt", &Stepping::fixed_dt, "Of every step [s]; 0: it is chosen for each.")
      .def_ro("sub_cycles", &Stepping::sub_cycles, "Whether steps may be longer than explicit viscosity allows.")
      .def_ro("viscous_contacts", &Stepping::viscous_contacts, "Kinds of contact that add to viscosity.")
      .def_ro("viscous_stages", &Stepping::viscous_stages, "Of the step to come; 0: its viscosity is explicit.");
  show(steps, "Stepping", {"solver", "cell", "cfl", "dt_max", "fixed_dt"});

  nb::class_<MaterialState> material(m, "MaterialState", "What the parameters of a material come to.");
  material.def_ro("type", &MaterialState::type, "newtonian, elastic, snow, ...")
      .def_ro("liquid", &MaterialState::liquid, "Whether it has no shape of its own.")
      .def_ro("particle_mass", &MaterialState::particle_mass, "[kg]")
      .def_ro("particle_volume", &MaterialState::particle_volume, "At rest [m^3].")
      .def_ro("sound_speed", &MaterialState::sound_speed, "At rest [m/s].")
      .def_ro("kinematic_viscosity", &MaterialState::kinematic_viscosity,
              "What bounds a step [m^2/s]; 0 where the law solves it implicitly.")
      .def_ro("poissons_ratio", &MaterialState::poissons_ratio,
              "Of small elastic strains [1]; 1/2 where volume alone resists.");
  show(material, "MaterialState", {"type", "particle_mass", "sound_speed", "kinematic_viscosity", "poissons_ratio"});

  nb::class_<BodyState> body(m, "BodyState", "Which particles came in as a body, whatever became of them since.");
  body.def_ro("material", &BodyState::material, "That it was made of.")
      .def_ro("first_id", &BodyState::first_id, "Its particles have the ids from this one on,")
      .def_ro("count", &BodyState::count, "as many as this.")
      .def_ro("color", &BodyState::color, "sRGB, 0 to 1; None: as the look of its material.");
  show(body, "BodyState", {"material", "first_id", "count", "color"});

  nb::class_<SpringAnchor> anchor(m, "SpringAnchor", "How a rigid body is held.");
  anchor.def_ro("at", &SpringAnchor::at, "The point of its shape, as the scene gives it [m].")
      .def_ro("to", &SpringAnchor::to, "Where it is drawn to [m].")
      .def_ro("stiffness", &SpringAnchor::stiffness, "[N/m]")
      .def_ro("damping", &SpringAnchor::damping, "[N s/m]");
  show(anchor, "SpringAnchor", {"at", "to", "stiffness", "damping"});

  Struct<VelocityBrush>(m, "VelocityBrush",
                        "A brush that is down: it takes along what lies within a sphere, the more the nearer to its\n"
                        "middle.")
      .member("point", &VelocityBrush::point, "Its middle [m].")
      .member("radius", &VelocityBrush::radius, "[m], above 0.")
      .member("velocity", &VelocityBrush::velocity, "Where to [m/s].")
      .member("rate", &VelocityBrush::rate, "How fast matter at the middle comes to that velocity [1/s].")
      .done();
}

nb::tuple corners(const Box3d& box) { return nb::make_tuple(box.min, box.max); }

void bind_shapes(nb::module_& m) {
  nb::class_<ColliderShape> c(m, "ColliderShape",
                              "The shape of a collider or rigid body where the solver has its surface, which is up to "
                              "`surface_tolerance` cells off its\n"
                              "pose. It stays as it was when it was asked for.");
  c.def_prop_ro("name", &ColliderShape::name)
      .def_prop_ro("mass", &ColliderShape::mass, "kg, of a rigid body; 0 of others.")
      .def_prop_ro("is_rigid", &ColliderShape::is_rigid, "Whether it is a rigid body.")
      .def(
          "distance", [](const ColliderShape& s, const Vector<"point">& p) { return s.distance(p); }, nb::arg("point"),
          "From its surface [m]; negative inside.")
      .def(
          "normal", [](const ColliderShape& s, const Vector<"point">& p) { return s.normal(p); }, nb::arg("point"),
          "Outward, of length 1.")
      .def(
          "velocity", [](const ColliderShape& s, const Vector<"point">& p) { return s.velocity(p); }, nb::arg("point"),
          "Of its surface there [m/s].")
      .def_prop_ro(
          "bounds", [](const ColliderShape& s) { return corners(s.bounds()); },
          nb::sig("def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]"),
          "Corners of a box that holds it as it stands [m].")
      .def_prop_ro(
          "own_bounds", [](const ColliderShape& s) { return corners(s.own_bounds()); },
          nb::sig("def own_bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]"),
          "The same of the shape as the scene gives it [m].");
  show(c, "ColliderShape", {"name", "mass", "bounds"});

  nb::class_<RayHit> hit(m, "RayHit", "What a ray meets first.");
  hit.def_ro("distance", &RayHit::distance, "From its origin [m].")
      .def_ro("point", &RayHit::point, "[m]")
      .def_ro("name", &RayHit::name, "Of the collider, rigid body or material.")
      .def_ro("id", &RayHit::id, "Of the particle; None: it is a collider or rigid body.");
  show(hit, "RayHit", {"distance", "point", "name", "id"});

  nb::class_<NearCollider> near(m, "NearCollider", "A collider or rigid body near a point.");
  near.def_ro("name", &NearCollider::name)
      .def_ro("distance", &NearCollider::distance, "From its surface [m]; negative inside.")
      .def_ro("is_rigid", &NearCollider::is_rigid, "Whether it is a rigid body.");
  show(near, "NearCollider", {"name", "distance", "is_rigid"});

  nb::class_<Contact> contact(m, "Contact", "Matter at the surface of a collider or rigid body.");
  contact.def_ro("material", &Contact::material)
      .def_ro("particles", &Contact::particles, "How many.")
      .def_ro("middle", &Contact::middle, "Of these particles [m].");
  show(contact, "Contact", {"material", "particles", "middle"});
}

/// float32 (n,) or (n, 3, 3)
nb::object attribute(Held& held, const std::string& material, const std::string& name) {
  auto* kept = new AttributeView(held.call([&](Simulation& s) { return s.attribute(material, name); }));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<AttributeView*>(p); });
  const std::size_t n = kept->size();
  const float* values = kept->values.data();
  if (kept->width == 9)
    return nb::cast(nb::ndarray<nb::numpy, const float, nb::shape<-1, 3, 3>>(values, {n, 3, 3}, owner));
  return nb::cast(nb::ndarray<nb::numpy, const float, nb::ndim<1>>(values, {n}, owner));
}

MaterialState material(Held& held, const std::string& name, const nb::kwargs& with) {
  std::vector<ParameterValue> values;
  for (const auto [key, value] : with)
    values.push_back({nb::cast<std::string>(key), nb::cast<double>(nb::float_(value))});
  return held.look([&](const Simulation& s) { return s.material(name, values); });
}

nb::dict brushes(Held& held) {
  nb::dict all;
  for (const std::string& name : held.look([](const Simulation& s) { return s.names().brushes; }))
    all[name.c_str()] = record_of(held.look([&](const Simulation& s) { return *s.brush(name); }));
  return all;
}

void bind_what_there_is(nb::class_<Held>& c) {
  c.def_prop_ro(
       "names", [](Held& h) { return h.look([](const Simulation& s) { return s.names(); }); },
       "What there is, by name: sim.names.colliders.")
      .def_prop_ro(
          "backend", [](Held& h) { return h.look([](const Simulation& s) { return s.backend(); }); },
          "cpu or reference.")
      .def_prop_ro(
          "isa", [](Held& h) { return h.look([](const Simulation& s) { return s.isa(); }); },
          "The instruction set that it computes by.")
      .def_prop_ro(
          "threads", [](Held& h) { return h.look([](const Simulation& s) { return s.threads(); }); },
          "That a step uses at most.")
      .def_prop_ro(
          "counts", [](Held& h) { return h.look([](const Simulation& s) { return s.counts(); }); },
          "Particles that are there, and those that came and went; `totals` has sums over them.")
      .def_prop_ro(
          "stepping", [](Held& h) { return h.look([](const Simulation& s) { return s.stepping(); }); },
          "All that the length of steps goes by.")
      .def_prop_rw(
          "cfl", [](Held& h) { return h.look([](const Simulation& s) { return s.cfl(); }); },
          [](Held& h, double cfl) { h.call([&](Simulation& s) { s.set_cfl(cfl); }); },
          "Cells that sound or matter may cross in a step from now on.")
      .def_prop_ro(
          "next_id", [](Held& h) { return h.look([](const Simulation& s) { return s.next_id(); }); },
          "All particles that are there have ids below this one, and those that come in later do not.")
      .def(
          "attribute", attribute, nb::arg("material"), nb::arg("name"),
          nb::sig("def attribute(self, material: str, name: str) -> numpy.typing.NDArray[numpy.float32]"),
          "A number of each particle of a material, in the order of their ids, float32 (n,), a matrix (n, 3, 3):\n"
          "f: deformation gradient [1], (n, 3, 3); j: volume over volume at rest [1]; jp: the plastic part of it [1];\n"
          "density [kg/m^3]; pressure [Pa]; velocity_gradient [1/s], (n, 3, 3). Where a material keeps no f or jp "
          "they\n"
          "are those of matter at rest. `attributes` lists what else there is.")
      .def(
          "attributes",
          [](Held& h, const std::string& m) { return h.look([&](const Simulation& s) { return s.attributes(m); }); },
          nb::arg("material"), "Names that `attribute` takes.")
      .def(
          "body",
          [](Held& h, const std::string& name) { return h.look([&](const Simulation& s) { return s.body(name); }); },
          nb::arg("name"), "Which particles came in as a body.")
      .def(
          "material", material, nb::arg("name"), nb::arg("parameters"),
          nb::sig("def material(self, name: str, **parameters: float) -> MaterialState"),
          "What a material comes to as it stands: sim.material('jelly').sound_speed; or, with other values of some of\n"
          "its parameters, as it would be: sim.material('jelly', youngs_modulus=1e5). Nothing is changed.")
      .def_prop_ro("brushes", brushes, nb::sig("def brushes(self) -> dict[str, VelocityBrush]"),
                   "That are down, by name.");
}

void bind_shape_queries(nb::class_<Held>& c) {
  c.def(
       "anchor",
       [](Held& h, const std::string& name) { return h.look([&](const Simulation& s) { return s.anchor(name); }); },
       nb::arg("name"), "The spring of `attach` on a rigid body; None where it has none.")
      .def(
          "collider_shape",
          [](Held& h, const std::string& name) {
            return h.look([&](const Simulation& s) { return s.collider_shape(name); });
          },
          nb::arg("name"), "Distances and normals of a collider or rigid body as it stands.")
      .def(
          "collider_shapes", [](Held& h) { return h.look([](const Simulation& s) { return s.collider_shapes(); }); },
          "Of all, in the order of names.colliders.")
      .def(
          "collider_mesh",
          [](Held& h, const std::string& name) { return h.call([&](Simulation& s) { return s.collider_mesh(name); }); },
          nb::arg("name"),
          "The surface of a collider as the scene gives it, to be drawn at its pose. Of a plane it is what lies "
          "between\n"
          "the walls, of one that deforms its first mesh.")
      .def(
          "load", [](Held& h, const std::filesystem::path& file) { h.advance([&](Simulation& s) { s.load(file); }); },
          nb::arg("file"), nb::sig("def load(self, file: str | os.PathLike[str]) -> None"),
          "Goes on from what `save` wrote, or starts any other scene file: as Simulation(Scene.load(FILE)), with the\n"
          "backend, threads and observers of this one. Where it raises, nothing has changed.")
      .def(
          "save_moment",
          [](Held& h, const std::filesystem::path& file, const std::optional<Scene>& finer) {
            h.call([&](Simulation& s) { finer ? s.save_moment(file, *finer) : s.save_moment(file); });
          },
          nb::arg("file"), nb::kw_only(), nb::arg("finer") = nb::none(),
          nb::sig("def save_moment(self, file: str | os.PathLike[str], *, finer: Scene | None = None) -> None"),
          "Writes the matter of this moment alone, for the `start` of a scene. finer: this scene at half the spacing,\n"
          "for which each particle becomes eight, with the same mass and momentum.");
}

}  // namespace

void bind_reads(nb::module_& m) {
  bind_names(m);
  bind_states(m);
  bind_shapes(m);
  m.def(
      "cast_ray",
      [](Held& held, const Vector<"origin">& origin, const Vector<"direction">& direction, double longest) {
        const Vec3d from = origin, along = direction;
        return held.call([&](Simulation& s) { return cast_ray(s, from, along, longest); });
      },
      nb::arg("simulation"), nb::arg("origin"), nb::arg("direction"),
      nb::arg("longest") = std::numeric_limits<double>::infinity(),
      "The first collider, rigid body or particle that a ray meets within `longest` [m], between the walls; None:\n"
      "nothing. Particles are balls of half a spacing; those that hold the origin do not count.");
  m.def(
      "colliders_near",
      [](Held& held, const Vector<"point">& point, double distance) {
        const Vec3d at = point;
        return held.look([&](const Simulation& s) { return colliders_near(s, at, distance); });
      },
      nb::arg("simulation"), nb::arg("point"), nb::arg("distance"),
      "Colliders and rigid bodies whose surface is nearer to a point [m] than `distance` [m], or that hold it.");
  m.def(
      "contacts",
      [](Held& held, const std::string& collider, std::optional<double> distance) {
        return held.call([&](Simulation& s) { return contacts(s, collider, distance); });
      },
      nb::arg("simulation"), nb::arg("collider"), nb::arg("distance") = nb::none(),
      "The particles that are nearer to the surface of a collider or rigid body than `distance` [m], or inside of it,\n"
      "by material; None: than a spacing.");
  m.def(
      "refused_parts", [](const Scene& scene) { return refused_parts(scene); }, nb::arg("scene"),
      "A line for each part of a scene that its `time.solver` cannot do, with its place and what would be right.");
}

void bind_reads_of(nb::class_<HeldSimulation>& simulation) {
  bind_what_there_is(simulation);
  bind_shape_queries(simulation);
}

}  // namespace dreampm::python
