#include "verbs.h"

namespace dreampm::cli {
namespace {

struct RunArguments {
  SceneArguments scene;
  std::string out, backend, isa = "auto";
  std::optional<int> frames;
  int threads = 0;
  bool resume = false, overwrite = false, strict = false;
};

int simulate_scene(const RunArguments& a) {
  model::Scene scene = a.scene.load();
  if (!a.out.empty()) scene.output.folder = a.out;
  SimulateOptions options;
  options.folder = scene.output.folder;
  options.frames = a.frames;
  options.threads = a.threads;
  options.backend = a.backend;
  options.isa = a.isa;
  options.resume = a.resume;
  options.overwrite = a.overwrite;
  options.strict = a.strict;
  const SimulateResult result = simulate(scene, a.scene.source(), options);
  fmt::print("{}: {} frames\n", scene.output.folder, result.frames_done);
  return 0;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto a = std::make_shared<RunArguments>();
  CLI::App* verb = add_verb(app, "run", "Simulate a scene: particles, ledger and checkpoints in a folder",
                            "dreampm run scenes/dam-break.yaml --frames 24 --set space.spacing=0.02");
  a->scene.add_to(*verb);
  verb->add_option("--out", a->out, "the run's folder (default: the scene's output.folder)");
  verb->add_option("--frames", a->frames, "stop after this frame")->transform(whole_number(1, 1000000));
  add_backend(*verb, a->backend, "cpu, with --resume the one that the run goes on from");
  add_isa(*verb, a->isa);
  CLI::Option* resume = verb->add_flag("--resume", a->resume, "go on from the newest checkpoint");
  verb->add_flag("--overwrite", a->overwrite, "replace a run that is in the folder")->excludes(resume);
  verb->add_flag("--strict", a->strict,
                 "stop with exit code 1 where the ledger does not close: mass, momentum, angular momentum, "
                 "energy from nowhere");
  add_threads(*verb, a->threads);
  verb->callback([a, &action] { action = [a] { return simulate_scene(*a); }; });
}

}  // namespace dreampm::cli
