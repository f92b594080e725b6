// The functions of the command's verbs `make` and `validate`.
#include <nanobind/stl/filesystem.h>

#include "bindings.h"
#include "convert.h"
#include "dreampm/base/file.h"
#include "dreampm/base/host.h"
#include "dreampm/base/parallel.h"
#include "dreampm/model/scene.h"
#include "dreampm/pipeline/make.h"
#include "dreampm/pipeline/replace_model.h"
#include "python_host.h"
#include "validate/report.h"
#include "validate/suite.h"

namespace dreampm::python {
namespace {

namespace fs = std::filesystem;

/// Calls body without the GIL, with the lines and the signals of Python.
template <class Body>
auto work(const Body& body) {
  PythonHost host;
  return host.run([&] {
    const HostScope scope(&host);
    return body();
  });
}

nb::object make_film(const fs::path& file, const std::string& variant, nb::object set, std::optional<std::string> out,
                     std::optional<std::string> model, std::string backend, int threads) {
  const SceneOptions options{variant, set_words(set)};
  nb::module_::import_("dreampm._video").attr("find_ffmpeg")();
  const fs::path film = work([&] {
    std::vector<std::string> warnings;
    model::Scene scene = load_scene(file, options, &warnings).model();
    for (const std::string& w : warnings) current_host().warning(w);
    if (out) scene.output.folder = *out;
    if (model) replace_model(scene, *model);
    const SceneSource source{file.string(), variant.empty() ? std::nullopt : std::optional<std::string>(variant)};
    make(scene, source, {.folder = scene.output.folder, .threads = threads, .backend = backend});
    return fs::path(scene.output.folder) / (scene.name + ".mp4");
  });
  return nb::cast(film);
}

nb::object validate_cases(const nb::args& names, bool full, const fs::path& out, std::string backend, int threads) {
  std::vector<const validate::Case*> cases;
  for (nb::handle name : names) cases.push_back(&validate::find_case(nb::cast<std::string>(name)));
  if (cases.empty())
    throw nb::type_error("validate(name, ...): names of cases, as `dreampm validate --list` prints them");
  validate::Options options;
  options.level = full ? validate::Level::full : validate::Level::quick;
  options.backend = std::move(backend);
  const std::string json = work([&] {
    const ThreadLimit limit(threads);
    validate::check_backend(options);
    make_folder(out);
    std::vector<validate::Result> results;
    for (const validate::Case* c : cases) results.push_back(validate::run_case(*c, options, out));
    return validate::json_of(results);
  });
  return nb::module_::import_("json").attr("loads")(json).attr("__getitem__")("cases");
}

}  // namespace

void bind_pipeline(nb::module_& m) {
  m.def(
      "make", make_film, nb::arg("file"), nb::kw_only(), nb::arg("variant") = "", nb::arg("set") = nb::none(),
      nb::arg("out") = nb::none(), nb::arg("model") = nb::none(), nb::arg("backend") = "", nb::arg("threads") = 0,
      nb::sig("def make(file: str | os.PathLike[str], *, variant: str = '', set: dict[str, object] | list[str] | "
              "None = None, "
              "out: str | None = None, model: str | None = None, backend: str = '', threads: int = 0) -> pathlib.Path"),
      "Simulates, meshes, draws and encodes a scene, as `dreampm make` does: goes on where it stopped, and leaves\n"
      "what is up to date. Returns the film; the run's folder is about it. out: the run's folder, else the scene's\n"
      "output.folder; model: a mesh in place of the scene's only one; backend: 'cpu', 'reference' or\n"
      "'cuda', else that of the run which is there, else 'cpu'. Lines about progress go to\n"
      "logging.getLogger('dreampm') at level INFO.");
  m.def("validate", validate_cases, nb::arg("names"), nb::kw_only(), nb::arg("full") = false,
        nb::arg("out") = fs::path("out/validation"), nb::arg("backend") = "", nb::arg("threads") = 0,
        nb::sig("def validate(*names: str, full: bool = False, out: str | os.PathLike[str] = 'out/validation', "
                "backend: str = '', threads: int = 0) -> list[dict[str, object]]"),
        "Compares the solver with experiments and exact solutions, as `dreampm validate` does: of every case a dict\n"
        "as `--json` prints it ('name', 'pass', 'metrics', ...). Plots go into the folder `out`. backend: 'cuda' for "
        "the\n"
        "runs in float, else 'cpu'.");
}

}  // namespace dreampm::python
