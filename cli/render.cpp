#include <charconv>

#include "verbs.h"

namespace dreampm::cli {
namespace {

struct RenderArguments {
  std::string folder, range;
  int frame = 0, threads = 0;
  RenderOptions options;
};

int number(std::string_view text, const std::string& range) {
  int n = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (error != std::errc{} || end != text.data() + text.size() || n < 1)
    fail_input("--frames is {}: must be A-B, such as 1-24", range);
  return n;
}

int render_frames(const RenderArguments& a) {
  const ThreadLimit limit(a.threads);
  RenderOptions options = a.options;
  if (a.frame > 0) options.first = options.last = a.frame;
  if (!a.range.empty()) {
    const std::size_t dash = a.range.find('-');
    options.first = number(std::string_view(a.range).substr(0, dash), a.range);
    options.last =
        dash == std::string::npos ? options.first : number(std::string_view(a.range).substr(dash + 1), a.range);
    if (options.last < options.first) fail_input("--frames is {}: the last frame lies before the first", a.range);
  }
  RunFolder run = open_run(a.folder, Access::write);
  if (render_stage(run, options).made == 0) info("nothing to do: {} is up to date", (run.folder / "render").string());
  if (a.frame > 0) fmt::print("{}\n", picture_file(run, a.frame).string());
  return 0;
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  auto a = std::make_shared<RenderArguments>();
  CLI::App* verb = add_verb(app, "render", "Draw the frames of a run",
                            "dreampm render out/dragon-splatting-preview --frame 60 --scale 2 --samples 64");
  verb->add_option("DIR", a->folder, "a run's folder with its surfaces")->required();
  auto* one = verb->add_option("--frame", a->frame, "only this frame")->transform(whole_number(1, 1000000));
  verb->add_option("--frames", a->range, "only frames A-B, both included")->excludes(one);
  verb->add_option("--scale", a->options.scale, "of the scene's picture size, above 0 to 4");
  verb->add_option("--samples", a->options.samples, "at most, a pixel (default: the scene's)")
      ->transform(whole_number(1, 1000000));
  add_threads(*verb, a->threads);
  verb->callback([a, &action] { action = [a] { return render_frames(*a); }; });
}

}  // namespace dreampm::cli
