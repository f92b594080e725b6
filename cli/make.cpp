#include "verbs.h"

namespace dreampm::cli {
namespace {

struct MakeArguments {
  SceneArguments scene;
  std::string model, out, isa = "auto";
  int threads = 0;
};

int make_all(const MakeArguments& a) {
  model::Scene scene = a.scene.load();
  if (!a.out.empty()) scene.output.folder = a.out;
  if (!a.model.empty()) replace_model(scene, a.model);
  const std::filesystem::path folder = scene.output.folder;
  const bool any = make(scene, a.scene.source(), {.folder = folder, .threads = a.threads, .isa = a.isa});
  if (!any) info("nothing to do: {} is up to date", folder.string());
  fmt::print("{}\n{}\n", (folder / (scene.name + ".mp4")).string(), (folder / "contact-sheet.png").string());
  return 0;
}

}  // namespace

void add_make(CLI::App& app, Action& action) {
  auto a = std::make_shared<MakeArguments>();
  CLI::App* verb = add_verb(app, "make", "Simulate, mesh, draw and encode a scene; goes on where it stopped",
                            "dreampm make scenes/dragon-splatting.yaml --variant preview");
  a->scene.add_to(*verb);
  verb->add_option(
      "--model", a->model,
      "a mesh in place of the scene's only one, made smaller where walls ask for it: a file or asset:knot");
  verb->add_option("--out", a->out, "the run's folder (default: the scene's output.folder)");
  add_isa(*verb, a->isa);
  add_threads(*verb, a->threads);
  verb->callback([a, &action] { action = [a] { return make_all(*a); }; });
}

}  // namespace dreampm::cli
