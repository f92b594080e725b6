#include "parts.h"
#include "model_members.h"

#include <nanobind/ndarray.h>

#include <algorithm>

#include "bindings.h"
#include "dreampm/base/error.h"

namespace dreampm::python {
namespace {

using List = std::vector<std::string>;

struct MaterialPart : PartOf {
  std::string name;
};
struct ColliderPart : PartOf {
  std::string name;
};

Names names_in(const PartOf& part) {
  return part.held().look([](const Simulation& s) { return s.names(); });
}

List names_of(const Materials& part) { return names_in(part).materials; }
List names_of(const ParticleSets& part) { return names_in(part).materials; }
List names_of(const Walls&) { return {side_names.begin(), side_names.end()}; }
List names_of(const Colliders& part) { return names_in(part).colliders; }
List names_of(const Probes& part) { return names_in(part).probes; }

/// The number of a name. Throws InputError with the names that there are.
template <class Part>
std::size_t number_of(const Part& part, const std::string& name, const char* kind) {
  const List names = names_of(part);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  std::string known;
  for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
  fail_input("{} {} is not in the scene; it has {}", kind, name, known.empty() ? "none" : known);
}

/// Adds the methods of dicts to a part that has `__getitem__`.
template <class C>
void as_mapping(C& bound) {
  using Part = typename C::Type;
  bound.def(
           "keys", [](const Part& part) { return names_of(part); }, "The names, in the order of the scene.")
      .def(
          "__iter__", [](const Part& part) { return nb::iter(nb::cast(names_of(part))); },
          nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"))
      .def("__len__", [](const Part& part) { return names_of(part).size(); })
      .def("__contains__",
           [](const Part& part, const std::string& name) {
             const List names = names_of(part);
             return std::find(names.begin(), names.end(), name) != names.end();
           })
      .def("__repr__", [](const Part& part) {
        return nb::cast<std::string>(nb::type<Part>().attr("__name__")) +
               nb::cast<std::string>(nb::repr(nb::tuple(nb::cast(names_of(part)))));
      });
}

// ---- materials

std::vector<Parameter> parameters_of(const MaterialPart& part) {
  return part.held().look([&](const Simulation& s) { return s.parameters(part.name); });
}

MaterialState state_of(const MaterialPart& part) {
  return part.held().look([&](const Simulation& s) { return s.material(part.name); });
}

bool is_flag(const Parameter& p) { return p.words.size() == 2 && p.words[0].first == "false"; }

/// A word where no number may stand for it, else the number; None: derived.
nb::object value_of(const Parameter& p) {
  if (std::isnan(p.value)) return nb::none();
  if (is_flag(p)) return nb::bool_(p.value != 0);
  for (const auto& [word, value] : p.words)
    if (value == p.value && (p.words_only || value < p.min || value > p.max)) return nb::str(word.data(), word.size());
  return nb::float_(p.value);
}

double number_of(const MaterialPart& part, const std::string& key, nb::handle value) {
  if (!nb::isinstance<nb::str>(value)) return nb::cast<double>(nb::float_(value));
  const std::string text = nb::cast<std::string>(value);
  std::string words;
  for (const Parameter& p : parameters_of(part)) {
    if (p.key != key) continue;
    for (const auto& [word, number] : p.words) {
      if (word == text) return number;
      words += std::string(words.empty() ? "" : ", ") + std::string(word);
    }
  }
  fail_input("materials.{}.{}: '{}' is no number{}", part.name, key, text, words.empty() ? "" : "; words: " + words);
}

nb::object parameter(const MaterialPart& part, const std::string& key) {
  const std::vector<Parameter> all = parameters_of(part);
  std::string known;
  for (const Parameter& p : all) {
    if (p.key == key) return value_of(p);
    known += std::string(known.empty() ? "" : ", ") + std::string(p.key);
  }
  throw nb::attribute_error(
      fmt::format("material {} ({}) has no parameter {}; it has {}", part.name, state_of(part).type, key, known)
          .c_str());
}

void set_parameter(const MaterialPart& part, const std::string& key, nb::handle value) {
  const double number = number_of(part, key, value);
  part.held().call([&](Simulation& s) { s.set_parameter(part.name, key, number); });
}

nb::dict parameters(const MaterialPart& part) {
  nb::dict all;
  for (const Parameter& p : parameters_of(part)) {
    nb::dict one;
    one["value"] = value_of(p);
    one["unit"] = std::string(p.unit);
    one["min"] = p.min;
    one["max"] = p.max;
    one["about"] = std::string(p.about);
    all[nb::str(p.key.data(), p.key.size())] = one;
  }
  return all;
}

constexpr const char* about_material =
    "A material of a simulation. Its parameters are attributes, by the names that `dreampm materials`\n"
    "lists: sim.materials['water'].viscosity = 0.1 [Pa s]. None: a value that the solver works out. What is\n"
    "set acts from the next step on, and is refused with InputError where a scene file could not say it.";

void bind_materials(nb::module_& m) {
  nb::class_<MaterialPart>(m, "Material", about_material, nb::type_slots(part_slots))
      .def("__getattr__", parameter, nb::arg("key"), nb::sig("def __getattr__(self, key: str) -> object"))
      .def("__setattr__", set_parameter, nb::arg("key"), nb::arg("value"),
           nb::sig("def __setattr__(self, key: str, value: float | bool | str) -> None"))
      .def("__dir__",
           [](const MaterialPart& part) {
             List names{"name", "type", "parameters", "reset_state"};
             for (const Parameter& p : parameters_of(part)) names.emplace_back(p.key);
             return names;
           })
      .def_prop_ro("name", [](const MaterialPart& part) { return part.name; })
      .def_prop_ro(
          "type", [](const MaterialPart& part) { return state_of(part).type; }, "newtonian, elastic, snow, ...")
      .def("parameters", parameters, nb::sig("def parameters(self) -> dict[str, dict[str, object]]"),
           "Of every parameter its value, unit, min, max and what it is about.")
      .def(
          "reset_state",
          [](const MaterialPart& part) { part.held().call([&](Simulation& s) { s.reset_state(part.name); }); },
          "Forgets the deformation: its particles are at rest volume, without stress. Positions and\n"
          "velocities stay.")
      .def("__repr__", [](const MaterialPart& part) {
        std::string text = fmt::format("<Material {}: {}", part.name, state_of(part).type);
        for (const Parameter& p : parameters_of(part))
          text += fmt::format(", {}={}", p.key, nb::cast<std::string>(nb::repr(value_of(p))));
        return text + ">";
      });
  nb::class_<Materials> all(m, "Materials", "The materials of a simulation by name.", nb::type_slots(part_slots));
  all.def("__getitem__", [](const Materials& part, const std::string& name) {
    number_of(part, name, "material");
    return MaterialPart{part, name};
  });
  as_mapping(all);
}

void bind_particle_sets(nb::module_& m) {
  nb::class_<ParticleSets> all(m, "ParticleSets", "The particles of a simulation by material.",
                               nb::type_slots(part_slots));
  all.def("__getitem__", [](const ParticleSets& part, const std::string& material) {
    return part.held().call([&](Simulation& s) { return s.particles(material); });
  });
  all.def(
      "on_device",
      [](const ParticleSets& part, const std::string& material) {
        return part.held().call([&](Simulation& s) { return s.device_particles(material); });
      },
      nb::arg("material"), nb::sig("def on_device(self, material: str) -> DeviceParticles"),
      "The particles of a material as arrays on the GPU that simulates, of the backend cuda: copied there, in the "
      "order\n"
      "of memory, with nothing brought to the host. Raises InputError where the backend keeps particles in the host's\n"
      "memory: sim.particles[material] has those as arrays of numpy.");
  as_mapping(all);
}

// ---- walls

nb::object wall(const Walls& part, const std::string& name) {
  const auto side = static_cast<Side>(number_of(part, name, "wall"));
  return record_of(part.held().look([&](const Simulation& s) { return s.wall(side); }));
}

void set_wall(const Walls& part, const std::string& name, nb::handle value) {
  const auto side = static_cast<Side>(number_of(part, name, "wall"));
  Wall wall;
  if (nb::isinstance<Record<Wall>>(value))
    wall = value_of(nb::cast<const Record<Wall>&>(value));
  else if (nb::isinstance<nb::str>(value))
    wall.type = Member<WallType>::from(value, "a wall's type");
  else if (nb::isinstance<nb::tuple>(value) && nb::len(value) == 2)
    wall.type = Member<WallType>::from(value[0], "a wall's type"), wall.friction = nb::cast<double>(value[1]);
  else
    throw nb::type_error("a wall is a type, as 'slip', or a type with its friction, as ('separate', 0.3)");
  part.held().call([&](Simulation& s) { s.set_wall(side, wall); });
}

void bind_walls(nb::module_& m) {
  nb::class_<Walls> all(
      m, "Walls",
      "The walls of a simulation's box: x_min, x_max, y_min (the floor), y_max, z_min, z_max.\n"
      "sim.walls['x_max'] = 'open', sim.walls['y_min'] = ('separate', 0.3): a type (separate, slip, stick,\n"
      "open), and Coulomb's coefficient of friction. Not on periodic axes.",
      nb::type_slots(part_slots));
  all.def("__getitem__", wall, nb::arg("name"), nb::sig("def __getitem__(self, name: str) -> model.Wall"))
      .def("__setitem__", set_wall, nb::arg("name"), nb::arg("wall"),
           nb::sig("def __setitem__(self, name: str, wall: str | tuple[str, float] | model.Wall) -> None"));
  as_mapping(all);
}

// ---- colliders

ColliderState state_of(const ColliderPart& part) {
  return part.held().look([&](const Simulation& s) { return s.collider(part.name); });
}

void bind_colliders(nb::module_& m) {
  nb::class_<ColliderPart>(m, "Collider", "A collider or a rigid body of a simulation.", nb::type_slots(part_slots))
      .def_prop_ro("name", [](const ColliderPart& part) { return part.name; })
      .def_prop_ro(
          "pose", [](const ColliderPart& part) { return state_of(part).pose; },
          "Where its shape, as the scene gives it, is now.")
      .def_prop_ro(
          "mass", [](const ColliderPart& part) { return state_of(part).mass; }, "kg, of a rigid body; 0 of others.")
      .def_prop_ro(
          "force", [](const ColliderPart& part) { return state_of(part).force; },
          "N: what matter pressed it with, on average over the steps of the last call.")
      .def_prop_ro(
          "type",
          [](const ColliderPart& part) { return wall_type_names.at(static_cast<std::size_t>(state_of(part).type)); },
          "What its surface does to matter: separate, slip or stick.")
      .def_prop_ro(
          "friction", [](const ColliderPart& part) { return state_of(part).friction; }, "Coulomb's coefficient.")
      .def_prop_ro(
          "restitution", [](const ColliderPart& part) { return state_of(part).restitution; },
          "Of impacts, 0 to 1, of a rigid body; 0 of others.")
      .def_prop_ro(
          "is_rigid", [](const ColliderPart& part) { return state_of(part).is_rigid; }, "Whether it is a rigid body.")
      .def_prop_ro(
          "moves", [](const ColliderPart& part) { return state_of(part).moves; },
          "Whether it may stand elsewhere than in the scene.")
      .def_prop_ro(
          "deforms", [](const ColliderPart& part) { return state_of(part).deforms; }, "Whether its shape changes.")
      .def_prop_rw(
          "surface_tolerance", [](const ColliderPart& part) { return state_of(part).surface_tolerance; },
          [](const ColliderPart& part, double cells) {
            part.held().call([&](Simulation& s) { s.set_surface_tolerance(part.name, cells); });
          },
          "Cells that it moves between two looks at where its surface is, above 0 to 0.25: each look takes as long\n"
          "as many steps.")
      .def_prop_rw(
          "motion", [](const ColliderPart& part) { return state_of(part).twist; },
          [](const ColliderPart& part, const Twist& motion) {
            part.held().call([&](Simulation& s) { s.set_motion(part.name, motion); });
          },
          "How it moves from the next step on, until another motion is set: Twist(velocity=, spin=, center=);\n"
          "Twist() stops it where it is.")
      .def("__repr__", [](nb::handle self) { return shown(self, "Collider", {"name", "pose", "motion"}); });
  nb::class_<Colliders> all(m, "Colliders", "The colliders and rigid bodies of a simulation by name.",
                            nb::type_slots(part_slots));
  all.def("__getitem__", [](const Colliders& part, const std::string& name) {
    number_of(part, name, "collider");
    return ColliderPart{part, name};
  });
  as_mapping(all);
}

// ---- probes

nb::object column_of(std::vector<double> values) {
  auto* const kept = new std::vector<double>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<1>>(kept->data(), {kept->size()}, owner));
}

nb::dict series(const Probes& part, const std::string& name) {
  const ProbeSeries rows = part.held().look([&](const Simulation& s) { return s.probe(name); });
  nb::dict all;
  all["time"] = column_of(rows.time);
  for (std::size_t c = 0; c < rows.columns.size(); ++c) {
    std::vector<double> column;
    for (const std::vector<double>& row : rows.rows) column.push_back(row[c]);
    all[rows.columns[c].c_str()] = column_of(std::move(column));
  }
  return all;
}

void bind_probes(nb::module_& m) {
  nb::class_<Probes> all(
      m, "Probes",
      "What the probes of a simulation have measured so far, by name: a dict of columns, 'time' [s] first, each\n"
      "an array of float64. pandas.DataFrame(sim.probes['level']) is a table. The rows are those of the probe's\n"
      "file in a run; `restore` goes back to those of its moment.",
      nb::type_slots(part_slots));
  all.def("__getitem__", series, nb::arg("name"),
          nb::sig("def __getitem__(self, name: str) -> dict[str, numpy.typing.NDArray[numpy.float64]]"));
  as_mapping(all);
}

}  // namespace

void bind_parts(nb::module_& m) {
  bind_particle_sets(m);
  bind_materials(m);
  bind_walls(m);
  bind_colliders(m);
  bind_probes(m);
}

}  // namespace dreampm::python
