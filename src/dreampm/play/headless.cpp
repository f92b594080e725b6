#include "dreampm/play/headless.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/play/app.h"

namespace dreampm::play {
namespace {

/// Of steps and frames that one line of a script may ask for.
constexpr int most_of_a_line = 1000000;

/// Draws frames into files.
class Drawer {
 public:
  explicit Drawer(const HeadlessOptions& options)
      : options_(options),
        app_([](Action) { return std::uint64_t{0}; }, options.play.simulation.threads, "headless", true) {
    make_folder(options.screenshots);
  }
  void draw(Playground& playground, int number) {
    Input input;
    input.time = number / 60.0;
    // Panels that fit their content know its size from the picture before.
    for (int turn = 0; turn < 2; ++turn) app_.draw(*playground.frame(), input, options_.width, options_.height, 1);
    write_png(options_.screenshots / fmt::format("frame-{:04}.png", number),
              options_.panels ? app_.picture() : app_.view());
  }

 private:
  const HeadlessOptions& options_;
  gl::HeadlessContext context_;
  App app_;
};

}  // namespace

std::uint64_t play_headless(Stage stage, const HeadlessOptions& options) {
  Playground playground(std::move(stage), options.play);
  std::optional<Drawer> drawer;
  if (!options.screenshots.empty()) drawer.emplace(options);
  int drawn = 0;
  const auto tick = [&](const Playground::Limit& limit) {
    if (interrupted()) throw Interrupted("interrupted");
    playground.tick(limit);
    ++drawn;
    if (drawer && drawn % options.every == 0) drawer->draw(playground, drawn);
  };
  if (!options.script.empty()) {
    std::istringstream lines(read_file(options.script));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      try {
        const Action action = Action::parse(line);
        if (action.verb.empty()) continue;
        if (action.verb == "steps") {
          tick({action.whole(0, most_of_a_line), {}});
        } else if (action.verb == "frames") {
          const int count = action.whole(0, most_of_a_line);
          for (int n = 0; n < count; ++n) tick({});
        } else {
          playground.act(action);
        }
      } catch (const InputError& e) {
        throw InputError(fmt::format("{}:{}:1: error: {}", options.script.string(), number, e.what()));
      }
    }
  }
  for (int n = 0; n < options.frames; ++n) tick({});
  return playground.hash();
}

}  // namespace dreampm::play
