#include "parts.h"

#include <nanobind/ndarray.h>

#include <algorithm>

#include "bindings.h"
#include "dreampm/base/error.h"
#include "dreampm/scene/description.h"
#include "dreampm/scene/sections.h"

namespace dreampm::python {
namespace {

using Names = std::vector<std::string>;

struct MaterialPart : PartOf {
  std::string name;
};
struct ColliderPart : PartOf {
  std::string name;
};

SceneDescription description_of(const PartOf& part) {
  return part.held().look([](const Simulation& s) { return s.scene().description(); });
}

Names names_of(const Materials& part) {
  return part.held().look([](const Simulation& s) { return s.scene().materials(); });
}
Names names_of(const ParticleSets& part) {
  return part.held().look([](const Simulation& s) { return s.scene().materials(); });
}
Names names_of(const Walls&) { return {scene::wall_names.begin(), scene::wall_names.end()}; }
Names names_of(const Colliders& part) {
  Names names;
  for (const scene::Collider& c : description_of(part).colliders) names.push_back(c.name);
  return names;
}

Names names_of(const Probes& part) {
  Names names;
  for (const scene::Probe& p : description_of(part).probes) names.push_back(p.name);
  return names;
}

/// The number of a name. Throws InputError with the names that there are.
template <class Part>
std::size_t number_of(const Part& part, const std::string& name, const char* kind) {
  const Names names = names_of(part);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  std::string known;
  for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
  fail_input("{} {} is not in the scene; it has {}", kind, name, known.empty() ? "none" : known);
}

/// What dicts have, for a part whose `__getitem__` is there.
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
             const Names names = names_of(part);
             return std::find(names.begin(), names.end(), name) != names.end();
           })
      .def("__repr__", [](const Part& part) {
        return nb::cast<std::string>(nb::type<Part>().attr("__name__")) +
               nb::cast<std::string>(nb::repr(nb::tuple(nb::cast(names_of(part)))));
      });
}

// ---- materials

scene::Material material_of(const MaterialPart& part) {
  SceneDescription scene = description_of(part);
  for (scene::Material& m : scene.materials)
    if (m.name == part.name) return m;
  fail_input("material {} is not in the scene any more", part.name);
}

/// A word where no number may stand for it, else the number; None: derived.
nb::object value_of(const Param& param, double value) {
  if (std::isnan(value)) return nb::none();
  if (param.words.data() == flag_words) return nb::bool_(value != 0);
  for (const Word& word : param.words)
    if (word.value == value && (param.words_only || value < param.min || value > param.max))
      return nb::str(word.name.data(), word.name.size());
  return nb::float_(value);
}

double number_of(const MaterialPart& part, const std::string& key, nb::handle value) {
  if (!nb::isinstance<nb::str>(value)) return nb::cast<double>(nb::float_(value));
  const std::string text = nb::cast<std::string>(value);
  const scene::Material material = material_of(part);
  std::string words;
  if (const Param* p = material.info->find(key))
    for (const Word& word : p->words) {
      if (word.name == text) return word.value;
      words += std::string(words.empty() ? "" : ", ") + std::string(word.name);
    }
  fail_input("materials.{}.{}: '{}' is no number{}", part.name, key, text, words.empty() ? "" : "; words: " + words);
}

nb::object parameter(const MaterialPart& part, const std::string& key) {
  const scene::Material material = material_of(part);
  if (const Param* p = material.info->find(key)) return value_of(*p, material.values[key]);
  std::string known;
  for (const Param& p : material.info->params) known += (known.empty() ? "" : ", ") + std::string(p.key);
  throw nb::attribute_error(
      fmt::format("material {} ({}) has no parameter {}; it has {}", part.name, material.info->name, key, known)
          .c_str());
}

void set_parameter(const MaterialPart& part, const std::string& key, nb::handle value) {
  const double number = number_of(part, key, value);
  part.held().call([&](Simulation& s) { s.set_parameter(part.name, key, number); });
}

nb::dict parameters(const MaterialPart& part) {
  const scene::Material material = material_of(part);
  nb::dict all;
  for (const Param& p : material.info->params) {
    nb::dict one;
    one["value"] = value_of(p, material.values[p.key]);
    one["unit"] = std::string(p.unit);
    one["min"] = p.min;
    one["max"] = p.max;
    one["about"] = std::string(p.help);
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
             Names names{"name", "type", "parameters", "reset_state"};
             for (const Param& p : material_of(part).info->params) names.emplace_back(p.key);
             return names;
           })
      .def_prop_ro("name", [](const MaterialPart& part) { return part.name; })
      .def_prop_ro(
          "type", [](const MaterialPart& part) { return std::string(material_of(part).info->name); },
          "newtonian, elastic, snow, ...")
      .def("parameters", parameters, nb::sig("def parameters(self) -> dict[str, dict[str, object]]"),
           "Of every parameter its value, unit, min, max and what it is about.")
      .def(
          "reset_state",
          [](const MaterialPart& part) { part.held().call([&](Simulation& s) { s.reset_state(part.name); }); },
          "Forgets the deformation: its particles are at rest volume, without stress. Positions and\n"
          "velocities stay.")
      .def("__repr__", [](const MaterialPart& part) {
        const scene::Material material = material_of(part);
        std::string text = fmt::format("<Material {}: {}", part.name, material.info->name);
        for (const Param& p : material.info->params)
          text += fmt::format(", {}={}", p.key, nb::cast<std::string>(nb::repr(value_of(p, material.values[p.key]))));
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
  as_mapping(all);
}

// ---- walls

struct WallValue {
  std::string type;
  double friction = 0;
};

WallValue wall(const Walls& part, const std::string& name) {
  const scene::Wall w = description_of(part).space.walls[number_of(part, name, "wall")];
  return {scene::wall_type_words().at(static_cast<std::size_t>(w.type)), w.friction};
}

void set_wall(const Walls& part, const std::string& name, nb::handle value) {
  const auto side = static_cast<Side>(number_of(part, name, "wall"));
  WallValue w;
  if (nb::isinstance<WallValue>(value))
    w = nb::cast<WallValue>(value);
  else if (nb::isinstance<nb::str>(value))
    w.type = nb::cast<std::string>(value);
  else if (nb::isinstance<nb::tuple>(value) && nb::len(value) == 2)
    w = {nb::cast<std::string>(value[0]), nb::cast<double>(value[1])};
  else
    throw nb::type_error("a wall is a type, as 'slip', or a type with its friction, as ('separate', 0.3)");
  part.held().call([&](Simulation& s) { s.set_wall(side, w.type, w.friction); });
}

void bind_walls(nb::module_& m) {
  nb::class_<WallValue> one(m, "Wall", "A wall of the box.");
  one.def_ro("type", &WallValue::type, "separate, slip, stick or open.")
      .def_ro("friction", &WallValue::friction, "Coulomb's coefficient, >= 0.")
      .def("__repr__", [](nb::handle self) { return shown(self, "Wall", {"type", "friction"}); });
  nb::class_<Walls> all(
      m, "Walls",
      "The walls of a simulation's box: x_min, x_max, y_min (the floor), y_max, z_min, z_max.\n"
      "sim.walls['x_max'] = 'open', sim.walls['y_min'] = ('separate', 0.3): a type (separate, slip, stick,\n"
      "open), and Coulomb's coefficient of friction. Not on periodic axes.",
      nb::type_slots(part_slots));
  all.def("__getitem__", wall)
      .def("__setitem__", set_wall, nb::arg("name"), nb::arg("wall"),
           nb::sig("def __setitem__(self, name: str, wall: str | tuple[str, float] | Wall) -> None"));
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
      .def_prop_rw(
          "motion", [](const ColliderPart& part) { return state_of(part).twist; },
          [](const ColliderPart& part, const Twist& motion) {
            part.held().call([&](Simulation& s) { s.set_motion(part.name, motion); });
          },
          "How it moves from the next step on, until another motion is set: Motion(velocity=, spin=, center=);\n"
          "Motion() stops it where it is.")
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
