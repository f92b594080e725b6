#include <fmt/format.h>

#include <algorithm>

#include "dreampm/backend/registry.h"
#include "dreampm/base/file.h"
#include "dreampm/gl/bench.h"
#include "dreampm/play/model/bench_play.h"
#include "dreampm/play/model/stories.h"
#include "dreampm/play/window/headless.h"
#include "dreampm/play/window/window.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {

struct PlayArguments {
  std::string what = "dam-break", record, script, screenshots, size, particles, backend;
  int preset = 1, frames = 60, every = 1, threads = 0;
  std::optional<std::uint64_t> random_actions;
  std::optional<float> ui_scale;
  bool headless = false, no_panels = false, list = false, verbs = false;
};

void read_size(const std::string& text, int& width, int& height) {
  const std::size_t x = text.find('x');
  const auto whole = [&](const std::string& part) {
    if (part.empty() || part.size() > 5 || part.find_first_not_of("0123456789") != part.npos) return 0;
    return std::stoi(part);
  };
  if (x != text.npos) width = whole(text.substr(0, x)), height = whole(text.substr(x + 1));
  if (x == text.npos || width < 1 || height < 1 || width > 8192 || height > 8192)
    throw InputError(fmt::format("--size is {}: must be WIDTHxHEIGHT in pixels, each from 1 to 8192", text));
}

int play(const PlayArguments& args) {
  if (args.list) {
    for (const dreampm::play::Story& s : dreampm::play::stories()) fmt::print("{:<16} {}\n", s.name, s.title);
    fmt::print("{:<16} {}\n", "report", "the report's own settings; --preset 1 or 2");
    return 0;
  }
  if (args.verbs) {
    for (const dreampm::play::Verb& v : dreampm::play::verbs())
      fmt::print("{:<9} {:<32} {}\n", v.name, v.usage, v.help);
    const auto say = [](const char* name, const char* usage, const char* help) {
      fmt::print("{:<9} {:<32} {}\n", name, usage, help);
    };
    say("plays", "NAME", "of a record: what it is of; it is refused where another is played");
    say("frames", "N", "that many drawn frames");
    say("steps", "N", "one drawn frame of exactly N steps");
    say("refused", "LINE", "of a record: what could not be done, which may be so again");
    return 0;
  }
  dreampm::play::PlayOptions options;
  options.simulation.threads = args.threads;
  if (!args.backend.empty()) {
    make_backend(args.backend);  // refused before a window opens
    options.simulation.backend = args.backend;
  }
  options.program = std::filesystem::read_symlink("/proc/self/exe");
  int width = 1280, height = 720;
  if (!args.size.empty()) read_size(args.size, width, height);
  dreampm::play::PlayScene scene = dreampm::play::load_play_scene(args.what, static_cast<std::size_t>(args.preset - 1));
  if (args.size.empty() && scene.window) width = scene.window->width, height = scene.window->height;
  if (!args.headless) {
    // Checks that would fail at the end are made before the window opens.
    if (!args.record.empty()) check_replaceable(args.record);
    dreampm::play::play_in_window(
        std::move(scene), {options, width, height, args.ui_scale, args.particles, args.record, args.size.empty()});
    return 0;
  }
  if (!args.particles.empty())
    scene = dreampm::play::resized(
        std::move(scene), static_cast<std::size_t>(std::ranges::find(dreampm::play::size_names(), args.particles) -
                                                   dreampm::play::size_names().begin()));
  const std::uint64_t hash = dreampm::play::play_headless(
      std::move(scene), {options, args.frames, args.script, args.screenshots, args.every, width, height, args.ui_scale,
                         !args.no_panels, args.random_actions});
  fmt::print("hash {:016x}\n", hash);
  return 0;
}

}  // namespace

void add_play(CLI::App& app, Action& action) {
  auto args = std::make_shared<PlayArguments>();
  CLI::App* verb =
      add_verb(app, "play", "Pour, push and change matter in a window: the playground", "dreampm play honey-coil");
  verb->add_option("scene", args->what, "a story (--list), a scene file, or a config.yaml of the report");
  verb->add_option("--preset", args->preset, "which preset of the report's config, from 1")
      ->transform(whole_number(1, 1000));
  verb->add_flag("--list", args->list, "lists the stories");
  verb->add_flag("--verbs", args->verbs, "lists what a script can say");
  verb->add_option("--size", args->size,
                   "of the window, in pixels; else 1280x720, of the report 1920x1080, or as a config.yaml says, "
                   "as far as the screen has room");
  verb->add_option("--ui-scale", args->ui_scale,
                   "of letters and panels, 0.5 to 4 (default: the monitor's, or more in a large window)")
      ->check(number_in(0.5, 4));
  verb->add_option("--particles", args->particles,
                   "small, medium or large; else medium, and small where the window does not keep up")
      ->check(CLI::IsMember(dreampm::play::size_names()));
  auto* record = verb->add_option("--record", args->record, "writes a script of all that happens in the window");
  auto* headless = verb->add_flag("--headless", args->headless,
                                  "plays without a window, and prints the hash of the world as its last line");
  headless->excludes(record);
  verb->add_option("--script", args->script, "a script to play first; with --headless")->needs(headless);
  verb->add_option("--frames", args->frames, "drawn frames to play, after the script; with --headless")
      ->needs(headless)
      ->transform(whole_number(0, 1000000));
  auto* screenshot =
      verb->add_option(
              "--screenshot", args->screenshots,
              "a file .png for a picture of the last drawn frame, or a folder for one of each; with --headless")
          ->needs(headless);
  verb->add_option("--every", args->every, "drawn frames from picture to picture, of a folder")
      ->needs(screenshot)
      ->transform(whole_number(1, 1000000));
  verb->add_flag("--no-panels", args->no_panels, "pictures and films of the whole window, without panels")
      ->needs(headless);
  verb->add_option("--random", args->random_actions,
                   "seed of random actions after the script, to look for what breaks; with --headless")
      ->needs(headless)
      ->transform(whole_number(0));
  add_backend(*verb, args->backend, "cpu");
  add_threads(*verb, args->threads);
  verb->callback([&action, args] { action = [args] { return play(*args); }; });
}

void add_bench_play(CLI::App& bench, Action& action) {
  struct Arguments {
    int threads = 0;
    double seconds = 2;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* verb =
      add_verb(bench, "play", "The playground beside the bare step, and its drawing without a graphics card",
               "dreampm bench play");
  add_threads(*verb, args->threads);
  verb->add_option("--seconds", args->seconds, "of each measurement")
      ->capture_default_str()
      ->check(number_in(0.01, 1000));
  verb->callback([args, &action] {
    action = [args] {
      for (const char* material : {"newtonian", "seed"})
        for (const int particles : {65536, 8192}) {
          const dreampm::play::PlayBenchResult r =
              dreampm::play::bench_play({material, particles, args->threads, args->seconds});
          fmt::print("play, {}, {} particles: {:.1f} M particle-steps/s, {:.2f} of the bare step's {:.1f}\n", material,
                     grouped(static_cast<std::uint64_t>(r.particles)), r.play, r.ratio, r.step);
          std::fflush(stdout);
        }
      for (const char* look : {"spheres", "water"}) {
        gl::DrawingBenchOptions options;
        options.look = look;
        const gl::DrawingBenchResult r = gl::bench_drawing(options);
        fmt::print("draw, {}, {} particles at {} x {}: {:.0f} ms of processor time, {:.0f} ms by the clock ({})\n",
                   look, grouped(static_cast<std::uint64_t>(options.particles)), options.width, options.height,
                   r.cpu_ms, r.wall_ms, r.driver);
        std::fflush(stdout);
      }
      return 0;
    };
  });
}

}  // namespace dreampm::cli
