#include "verbs.h"

namespace dreampm::cli {
namespace {

struct FoamArguments {
  std::vector<std::string> names;
  std::string frames, up = "y";
  LooseFoam loose;
  std::vector<std::string> of_files;  ///< options given that only files take
  int threads = 0;
};

int foam_run(const FoamArguments& a) {
  RunFolder run = open_run(a.names[0], Access::write);
  if (!run.scene.foam)
    fail_input("{}: the scene has no foam; write `foam: {{}}` into it for all defaults",
               (run.folder / "scene.yaml").string());
  FrameRange frames;
  if (!a.frames.empty()) std::tie(frames.first, frames.last) = frame_range(a.frames);
  if (foam_stage(run, frames).made == 0) info("nothing to do: {} is up to date", (run.folder / "foam").string());
  return 0;
}

int foam(const FoamArguments& a) {
  const ThreadLimit limit(a.threads);
  if (names_run(a.names, a.of_files)) return foam_run(a);
  if (!a.frames.empty()) fail_input("--frames is for a run's folder; of files name those that are to have foam");
  LooseFoam request = a.loose;
  request.files = a.names;
  request.up = ups().at(a.up);
  for (const std::filesystem::path& f : foam_of_files(request)) fmt::print("{}\n", f.string());
  return 0;
}

}  // namespace

void add_foam(CLI::App& app, Action& action) {
  auto a = std::make_shared<FoamArguments>();
  CLI::App* verb =
      add_verb(app, "foam", "Make spray, foam, bubbles and dust of a run's frames, or spray, foam and bubbles of files",
               "dreampm foam out/foaming-dam\n"
               "dreampm foam cache/fluid_*.bgeo --spacing 0.02 --fps 30");
  verb->add_option("DIR", a->names,
                   "a run's folder, whose scene has foam; or files of particles with velocities, in meters and "
                   "seconds, each a frame")
      ->required();
  verb->add_option("--frames", a->frames,
                   "of a run: A-B: only these frames, of which the one before the first has foam");
  model::Foam& settings = a->loose.foam;
  std::vector<CLI::Option*> of_files{
      verb->add_option("--spacing", a->loose.spacing, "of files: the distance between particles [m]")
          ->check(number_in(1e-9, 1e9)),
      verb->add_option("--fps", a->loose.fps, "of files: frames a second")
          ->capture_default_str()
          ->check(number_in(1e-3, 1e6)),
      verb->add_option("--up", a->up, "of files: the axis that points up, y or z")
          ->capture_default_str()
          ->check(CLI::IsMember(ups())),
      verb->add_option("--amount", settings.amount, "of files: times everything that is emitted")
          ->capture_default_str()
          ->check(number_in(0, 1000)),
      verb->add_option("--radius", settings.radius,
                       "of files: the mean radius [m] (default: by the volume of the matter)")
          ->check(number_in(1e-9, 1e9)),
      verb->add_option("--most", settings.most, "of files: the most that are there at once")
          ->capture_default_str()
          ->transform(whole_number(1, 100000000)),
      verb->add_option("--out", a->loose.out, "of files: the folder of their foam")->capture_default_str()};
  add_threads(*verb, a->threads);
  verb->callback([a, of_files, &action] {
    a->of_files = given(of_files);
    action = [a] { return foam(*a); };
  });
}

}  // namespace dreampm::cli
