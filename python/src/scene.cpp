// Scenes: from files, from text, or built of sections.
#include "dreampm/scene.h"

#include <nanobind/stl/filesystem.h>

#include "bindings.h"
#include "convert.h"
#include "model_members.h"
#include "python_host.h"

namespace dreampm::python {
namespace {

/// A section a line, so that a message's line is its section's.
std::string text_of(nb::handle sections) {
  std::string text;
  const auto given = [&](const char* name) { return nb::cast<bool>(sections.attr("__contains__")(name)); };
  if (!given("dreampm")) text += "dreampm: 1\n";
  if (!given("name")) text += "name: scene\n";
  for (nb::handle item : sections.attr("items")())
    text += nb::cast<std::string>(nb::str(item[0])) + ": " + yaml_of(item[1]) + "\n";
  return text;
}

template <class Read>
Scene warned(const Read& read) {
  PythonHost host;
  std::vector<std::string> warnings;
  Scene scene = host.run([&] { return read(&warnings); });
  for (const std::string& w : warnings) host.warning(w);
  return scene;
}

Scene parsed(const std::string& text, const std::string& file, const std::string& variant, nb::handle set) {
  const SceneOptions options{variant, set_words(set)};
  return warned([&](auto* warnings) { return parse_scene(text, file, options, warnings); });
}

Scene built(nb::object text, const std::string& file, const std::string& variant, nb::handle set,
            const nb::kwargs& sections) {
  if (text.is_none() == (sections.size() == 0))
    throw nb::type_error(
        "Scene(model), Scene(text), Scene(dict) or Scene(space=..., materials=..., bodies=...): one of them");
  if (nb::isinstance<Record<model::Scene>>(text)) {
    if (!variant.empty() || !set.is_none())
      throw nb::type_error("Scene(model): change the model; variant and set are of files");
    return Scene(value_of(nb::cast<const Record<model::Scene>&>(text)), file == "scene" ? "" : file);
  }
  if (text.is_none()) return parsed(text_of(sections), file, variant, set);
  if (nb::isinstance<nb::str>(text)) return parsed(nb::cast<std::string>(text), file, variant, set);
  if (!nb::hasattr(text, "items"))
    throw nb::type_error("Scene(text): a scene file as a str, or its sections as a dict; Scene.load reads a file");
  return parsed(text_of(text), file, variant, set);
}

constexpr const char* about_scene =
    "A checked scene with every default filled in. Immutable; may be shared between threads.\n\n"
    "    Scene.load('dam-break.yaml', variant='preview', set={'space.spacing': 0.01})\n"
    "    Scene(space={'min': [0, 0, 0], 'max': [1, 1, 1], 'spacing': 0.02},\n"
    "          materials={'water': {'type': 'newtonian', 'preset': 'water'}},\n"
    "          bodies={'drop': {'material': 'water', 'shape': {'sphere': {'radius': 0.1}, 'center': [0.5, 0.5, "
    "0.5]}}})\n\n"
    "A program may build one of structs, too: Scene(dreampm.model.Scene(...)).\n\n"
    "Sections and keys are those of scene files, and so are the errors: InputError names each with\n"
    "FILE:LINE:COLUMN. Of sections given as keywords the line counts sections.";

constexpr const char* about_scene_init =
    "text:     a model.Scene, a scene file as a str, or its sections as a dict; or, without it, sections as keywords.\n"
    "          `dreampm: 1` and a name are put before sections that lack them.\n"
    "file:     stands for the file in messages; models are looked for in its folder.\n"
    "variant:  one of the scene's variants; empty: the scene as it stands.\n"
    "set:      values laid over it: {'space.spacing': 0.01}, or a list of 'PATH=VALUE'.";

}  // namespace

void bind_scene(nb::module_& m) {
  nb::class_<Scene>(m, "Scene", about_scene)
      .def(
          "__init__",
          [](Scene* self, nb::object text, const std::string& file, const std::string& variant, nb::object set,
             const nb::kwargs& sections) { new (self) Scene(built(text, file, variant, set, sections)); },
          nb::arg("text") = nb::none(), nb::kw_only(), nb::arg("file") = "scene", nb::arg("variant") = "",
          nb::arg("set") = nb::none(), nb::arg("sections"),
          nb::sig("def __init__(self, text: model.Scene | str | dict[str, object] | None = None, *, file: str = "
                  "'scene', variant: "
                  "str = '', "
                  "set: dict[str, object] | list[str] | None = None, **sections: object) -> None"),
          about_scene_init)
      .def_static(
          "load",
          [](const std::filesystem::path& file, const std::string& variant, nb::object set) {
            const SceneOptions options{variant, set_words(set)};
            return warned([&](auto* warnings) { return load_scene(file, options, warnings); });
          },
          nb::arg("file"), nb::kw_only(), nb::arg("variant") = "", nb::arg("set") = nb::none(),
          nb::sig("def load(file: str | os.PathLike[str], *, variant: str = '', set: dict[str, object] | list[str] | "
                  "None = None) -> "
                  "Scene"),
          "Reads and checks a scene file. Warnings go to logging.getLogger('dreampm').")
      .def(
          "with_", [](const Scene& s, nb::object set) { return s.with(set_words(set)); }, nb::arg("set"),
          nb::sig("def with_(self, set: dict[str, object] | list[str]) -> Scene"),
          "The same scene with values laid over it.")
      .def_prop_ro("name", &Scene::name)
      .def_prop_ro("file", &Scene::file, "As messages name it.")
      .def_prop_ro("min", &Scene::min, "A corner of the box of walls [m].")
      .def_prop_ro("max", &Scene::max, "The opposite corner [m].")
      .def_prop_ro("spacing", &Scene::spacing, "Between particles [m].")
      .def_prop_ro("fps", &Scene::fps, "Frames a second of simulated time.")
      .def_prop_ro("frame_count", &Scene::frames, "Frame 1 is the start, frame n is at (n - 1)/fps.")
      .def_prop_ro("material_names", &Scene::materials)
      .def_prop_ro(
          "model", [](const Scene& s) { return record_of(s.model()); }, nb::sig("def model(self) -> model.Scene"),
          "All that it says, as a copy that may be changed: Scene(model) checks it again.")
      .def("yaml", &Scene::yaml, "The whole scene as a scene file, every value explicit.")
      .def(
          "__reduce__",
          [](nb::handle self) {
            const auto& scene = nb::cast<const Scene&>(self);
            return nb::make_tuple(
                nb::module_::import_("functools").attr("partial")(self.type(), nb::arg("file") = scene.file()),
                nb::make_tuple(scene.yaml()));
          },
          nb::sig("def __reduce__(self) -> tuple[object, ...]"))
      .def("__repr__", [](nb::handle self) {
        return shown(self, "Scene", {"name", "file", "spacing", "fps", "frame_count", "material_names"});
      });
  m.def(
      "preset", [](const std::string& type, const std::string& name) { return preset(type, name); }, nb::arg("type"),
      nb::arg("name"), nb::sig("def preset(type: str, name: str) -> model.Values"),
      "The values of a preset, as `dreampm materials TYPE` lists them: preset('newtonian', 'honey').");
  m.def(
      "check", [](const Record<model::Scene>& model) { return check(value_of(model)); }, nb::arg("model"),
      nb::sig("def check(model: model.Scene) -> list[str]"),
      "What is wrong with a scene that a program built, a line each, by path; reads no file.");
}

}  // namespace dreampm::python
