#include "dreampm/play/window/headless.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/window/app.h"
#include "dreampm/state/grid.h"

namespace dreampm::play {
namespace {

/// Of steps and frames that one line of a script may ask for.
constexpr int most_of_a_line = 1000000;

/// Draws frames into files.
class Drawer {
 public:
  Drawer(const HeadlessOptions& options, const Playground& playground)
      : options_(options),
        app_([](Action) { return std::uint64_t{0}; }, playground.threads(), playground.backend(), true) {
    app_.show_panels(options.panels);
  }
  /// Into a film where the frame asks for one, and into a picture, where a file is given.
  void draw(Playground& playground, int number, const std::filesystem::path& file) {
    Input input;
    input.time = number / 60.0;
    const std::shared_ptr<const Frame> frame = playground.frame();
    // Panels that fit their content know its size from the picture before.
    if (!file.empty()) app_.update(*frame, input, options_.width, options_.height, scale_);
    app_.draw(*frame, input, options_.width, options_.height, scale_);
    if (!file.empty()) write_png(file, options_.panels ? app_.picture() : app_.view());
  }
  void end_film() { app_.finish_films(); }

 private:
  const HeadlessOptions& options_;
  const float scale_ = options_.ui_scale.value_or(scale_of_size(options_.width, options_.height));
  gl::HeadlessContext context_;
  App app_;
};

/// Where pictures go: to many files of a folder, or to one, of the last frame.
class Screenshots {
 public:
  /// Throws InputError for what cannot be written.
  explicit Screenshots(const HeadlessOptions& options) : options_(options) {
    const std::filesystem::path& to = options.screenshots;
    if (to.empty()) return;
    is_one_ = to.extension() == ".png" && !std::filesystem::is_directory(to);
    for (const std::string_view ending : {".jpg", ".jpeg", ".exr", ".bmp", ".tif", ".tiff", ".webp", ".gif"})
      if (to.extension() == ending)
        throw InputError(fmt::format(
            "--screenshot is {}: must be a file that ends in .png, or a folder; pictures are PNG files", to.string()));
    if (!is_one_)
      make_folder(to);
    else if (options.every != 1)
      throw InputError(fmt::format("--every {} needs a folder, and --screenshot {} is one picture, of the last frame",
                                   options.every, to.string()));
    else
      check_replaceable(to);
  }
  /// The file of that drawn frame; empty: it has none.
  std::filesystem::path file(int number) const {
    if (options_.screenshots.empty() || is_one_ || number % options_.every != 0) return {};
    return options_.screenshots / fmt::format("frame-{:04}.png", number);
  }
  /// The one file; empty: there is none.
  std::filesystem::path last() const { return is_one_ ? options_.screenshots : std::filesystem::path(); }

 private:
  const HeadlessOptions& options_;
  bool is_one_ = false;
};

/// Drawn frames that random actions stay at a scene, and from one of them to the next.
constexpr int stay = 150, pause = 2;

void do_anything(RandomActions& actions, Playground& playground, int frame) {
  const std::shared_ptr<const Frame> now = playground.frame();
  const Box3d& box = now->domain;
  const model::Space& space = playground.simulation().scene().model().space;
  // Walls hold matter to within its precision; through open sides it goes a whole box before it is
  // taken out, by blocks.
  const auto slack = [&](int side) {
    return space.walls[static_cast<std::size_t>(side)].type == WallType::open
               ? box.size()[side / 2] + 2 * block_width * space.dx()
               : 1e-3 * now->spacing;
  };
  for (const Frame* side : {&now->side_a(), &now->side_b()})
    for (const MatterFrame& matter : side->matter)
      for (const Vec3f& x : matter.position)
        for (int a = 0; a < 3; ++a)
          if (const auto at = static_cast<double>(x[a]);
              !(at >= box.min[a] - slack(2 * a) && at <= box.max[a] + slack(2 * a + 1)))
            throw RunError(
                fmt::format("frame {} of {}: {} is at ({}, {}, {})", frame, now->story, matter.name, x.x, x.y, x.z));
  if (frame % pause != 0) return;
  try {
    playground.act(frame % stay == 0 ? actions.open() : actions.next(*now));
  } catch (const InputError&) {
    // As a person's is, what cannot be done is refused.
  }
}

/// A film that was asked for is what the run is for.
void wait_for_film(Playground& playground) {
  std::string said;
  while (const std::shared_ptr<const RenderStatus> film = playground.frame()->rendering) {
    if (film->state == RenderStatus::State::failed) throw RunError(film->what);
    if (!film->film.empty()) info("{}", film->film);
    if (!film->under_way()) return;
    if (interrupted())
      throw Interrupted(fmt::format("interrupted; dreampm make {} goes on with the film", film->scene));
    if (film->stage != said) info("the film: {}, {} left in all", said = film->stage, duration_text(film->left));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

std::uint64_t play_headless(PlayScene scene, const HeadlessOptions& options) {
  // What is drawn does not depend on how fast the machine is.
  PlayOptions play = options.play;
  play.step_seconds = 0;
  Playground playground(std::move(scene), play);
  const Screenshots screenshots(options);
  std::optional<Drawer> drawer;
  int drawn = 0;
  const auto tick = [&](const Playground::Limit& limit) {
    if (interrupted()) throw Interrupted("interrupted");
    playground.tick(limit);
    ++drawn;
    const std::filesystem::path file = screenshots.file(drawn);
    const bool draws = !file.empty() || playground.is_filmed();
    if (!drawer && draws) drawer.emplace(options, playground);
    if (drawer && !playground.is_filmed()) drawer->end_film();
    if (draws) drawer->draw(playground, drawn, file);
  };
  if (!options.script.empty()) {
    std::istringstream lines(read_file(options.script));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      try {
        const Action action = Action::parse(line);
        if (action.verb.empty()) continue;
        if (action.verb == "plays") {
          if (const std::string& name = playground.frame()->story; action.word(0) != name)
            throw InputError(fmt::format("it is a record of {}, and {} is played", action.word(0), name));
        } else if (action.verb == "steps") {
          tick({action.whole(0, most_of_a_line), {}});
        } else if (action.verb == "frames") {
          const int count = action.whole(0, most_of_a_line);
          for (int n = 0; n < count; ++n) tick({});
        } else if (action.verb == "refused") {
          // A record has it: done again, so that whatever it left is the same.
          try {
            playground.act(Action::parse(line.substr(line.find(action.verb) + action.verb.size())));
          } catch (const Error&) {
          }
        } else {
          playground.act(action);
        }
      } catch (const InputError& e) {
        throw InputError(fmt::format("{}:{}:1: error: {}", options.script.string(), number, e.what()));
      }
    }
  }
  std::optional<RandomActions> actions;
  if (options.random_actions) actions.emplace(*options.random_actions);
  for (int n = 0; n < options.frames; ++n) {
    if (actions) do_anything(*actions, playground, n);
    tick({});
  }
  if (drawer) drawer->end_film();
  if (const std::filesystem::path file = screenshots.last(); !file.empty()) {
    // The last frame is in its film already.
    if (playground.is_filmed()) playground.act({"film", {"off"}});
    if (!drawer) drawer.emplace(options, playground);
    drawer->draw(playground, drawn, file);
  }
  if (const std::string lost = playground.frame()->lost; !lost.empty()) info("{}", lost);
  wait_for_film(playground);
  return playground.hash();
}

}  // namespace dreampm::play
