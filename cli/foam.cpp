#include "verbs.h"

namespace dreampm::cli {
namespace {

struct FoamArguments {
  std::string folder, frames;
  int threads = 0;
};

int foam(const FoamArguments& a) {
  const ThreadLimit limit(a.threads);
  RunFolder run = open_run(a.folder, Access::write);
  if (!run.scene.foam)
    fail_input("{}: the scene has no foam; write `foam: {{}}` into it for all defaults",
               (run.folder / "scene.yaml").string());
  FrameRange frames;
  if (!a.frames.empty()) std::tie(frames.first, frames.last) = frame_range(a.frames);
  if (foam_stage(run, frames).made == 0) info("nothing to do: {} is up to date", (run.folder / "foam").string());
  return 0;
}

}  // namespace

void add_foam(CLI::App& app, Action& action) {
  auto a = std::make_shared<FoamArguments>();
  CLI::App* verb =
      add_verb(app, "foam", "Make spray, foam, bubbles and dust of a run's frames", "dreampm foam out/foaming-dam");
  verb->add_option("DIR", a->folder, "a run's folder, whose scene has foam")->required();
  verb->add_option("--frames", a->frames, "A-B: only these frames, of which the one before the first has foam");
  add_threads(*verb, a->threads);
  verb->callback([a, &action] { action = [a] { return foam(*a); }; });
}

}  // namespace dreampm::cli
