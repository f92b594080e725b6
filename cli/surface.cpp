#include "verbs.h"

namespace dreampm::cli {
namespace {

struct SurfaceArguments {
  std::string folder;
  int threads = 0;
};

int surface(const SurfaceArguments& a) {
  const ThreadLimit limit(a.threads);
  RunFolder run = open_run(a.folder, Access::write);
  if (meshed_materials(run.scene).empty())
    info("nothing to do: every material is drawn as spheres");
  else if (surface_stage(run).made == 0)
    info("nothing to do: {} is up to date", (run.folder / "surface").string());
  return 0;
}

}  // namespace

void add_surface(CLI::App& app, Action& action) {
  auto a = std::make_shared<SurfaceArguments>();
  CLI::App* verb =
      add_verb(app, "surface", "Wrap the particles of a run in meshes", "dreampm surface out/dragon-splatting-preview");
  verb->add_option("DIR", a->folder, "a run's folder")->required();
  add_threads(*verb, a->threads);
  verb->callback([a, &action] { action = [a] { return surface(*a); }; });
}

}  // namespace dreampm::cli
