#include <map>

#include "verbs.h"

namespace dreampm::cli {
namespace {

struct RenderArguments {
  std::vector<std::string> names;
  std::string range, up = "y";
  int frame = 0, threads = 0;
  RenderOptions options;
  LoosePictures loose;
  std::vector<std::string> of_files, of_runs;  ///< options given that only files, or runs, take
};

int render_run(const RenderArguments& a) {
  RenderOptions options = a.options;
  if (a.frame > 0) options.first = options.last = a.frame;
  if (!a.range.empty()) std::tie(options.first, options.last) = frame_range(a.range);
  RunFolder run = open_run(a.names[0], Access::write);
  if (render_stage(run, options).made == 0) info("nothing to do: {} is up to date", (run.folder / "render").string());
  if (a.frame > 0) fmt::print("{}\n", picture_file(run, a.frame).string());
  return 0;
}

int render_frames(const RenderArguments& a) {
  const ThreadLimit limit(a.threads);
  if (names_run(a.names, a.of_files)) return render_run(a);
  if (!a.of_runs.empty())
    fail_input("{} is for a run's folder; of files name those that are to be drawn", a.of_runs[0]);
  LoosePictures request = a.loose;
  request.files = a.names;
  request.up = ups().at(a.up);
  request.scale = a.options.scale, request.samples = a.options.samples;
  for (const std::filesystem::path& f : render_files(request)) fmt::print("{}\n", f.string());
  return 0;
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  auto a = std::make_shared<RenderArguments>();
  CLI::App* verb = add_verb(app, "render", "Draw the frames of a run, or files of meshes or particles",
                            "dreampm render out/dragon-splatting-preview --frame 60 --scale 2 --samples 64\n"
                            "dreampm render meshes/*.ply --look water");
  verb->add_option("DIR", a->names, "a run's folder with its surfaces; or files of meshes or particles, each a frame")
      ->required();
  auto* one = verb->add_option("--frame", a->frame, "of a run: only this frame")->transform(whole_number(1, 1000000));
  auto* some =
      verb->add_option("--frames", a->range, "of a run: only frames A-B, or A:B, both included")->excludes(one);
  verb->add_option("--scale", a->options.scale, "of the picture's size (files: of 1280 x 720)")
      ->check(number_in(0.01, 4));
  verb->add_option("--samples", a->options.samples, "at most, a pixel (default: the scene's; files: 32)")
      ->transform(whole_number(2, 65536));
  std::vector<CLI::Option*> of_files{
      verb->add_option("--look", a->loose.look,
                       "of files: water, glass, clay, plastic or metal (default: water for closed meshes, else clay)")
          ->check(CLI::IsMember(picture_looks())),
      verb->add_option("--spacing", a->loose.spacing,
                       "of files: the distance between particles, in their unit (default: as they lie)")
          ->check(number_in(1e-9, 1e9)),
      verb->add_option("--up", a->up, "of files: the axis that points up in them, y or z")
          ->check(CLI::IsMember(ups()))
          ->capture_default_str(),
      verb->add_option("--azimuth", a->loose.azimuth, "of files: where the camera stands [degrees]")
          ->capture_default_str()
          ->check(number_in(-360, 360)),
      verb->add_option("--elevation", a->loose.elevation, "of files: how high it stands [degrees]")
          ->capture_default_str()
          ->check(number_in(-89, 89)),
      verb->add_option("--out", a->loose.out, "of files: the folder of their pictures")->capture_default_str()};
  add_threads(*verb, a->threads);
  verb->callback([a, of_files, one, some, &action] {
    a->of_files = given(of_files), a->of_runs = given({one, some});
    action = [a] { return render_frames(*a); };
  });
}

}  // namespace dreampm::cli
