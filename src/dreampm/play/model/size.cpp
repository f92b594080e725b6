// Small, medium and large: the same scene with other numbers of particles.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/action.h"
#include "dreampm/play/model/play_model.h"
#include "dreampm/play/model/size_chooser.h"
#include "dreampm/play/model/solver_choice.h"

namespace dreampm::play {
namespace {

/// Times the spacing of the scene: a step costs as its particles do, and steps are as long as a
/// spacing. The costs of a second are 0.3, 1 and 2.5.
constexpr std::array<double, 3> spacings{1.35, 1, 0.8};

/// s of the clock: what a scene takes to begin, and for how long it is measured.
constexpr double beginning = 0.3, measured = 1;
/// Of real time: below this the machine does not keep up.
constexpr double too_slow = 0.75;

std::string number_text(const PlayModel& side) {
  // Where taps give matter the number at the start says nothing.
  return side.play_scene().scene.model().emitters.empty()
             ? fmt::format("{} particles", grouped(side.simulation->particle_count()))
             : fmt::format("particles {:.3g} mm apart", 1e3 * side.play_scene().scene.spacing());
}

}  // namespace

const std::vector<std::string>& size_names() {
  static const std::vector<std::string> names{"small", "medium", "large"};
  return names;
}

PlayScene resized(PlayScene scene, std::size_t size) {
  const model::Scene& model = scene.scene.model();
  if (size == scene.size) return scene;
  if (scene.report) throw InputError("size: the report has a grid of its own");
  if (!model.start.empty())
    throw InputError(fmt::format("size: {} starts from a moment, with the particles that it has", scene.name));
  const double spacing = model.space.spacing * spacings.at(size) / spacings.at(scene.size);
  scene.scene = scene.scene.with({fmt::format("space.spacing={:.6g}", spacing)});
  scene.size = size;
  return scene;
}

void Playground::resize(std::size_t size) {
  PlayScene next = resized(first_->play_scene(), size);
  const auto before = std::exchange(size_, size);
  try {
    open(std::move(next));
  } catch (...) {
    size_ = before;
    throw;
  }
  first_->say(fmt::format("{}: {}", size_names().at(size), number_text(*first_)));
}

void Playground::choose_solver(SolverKind solver) {
  if (first_->play_scene().scene.model().time.solver == solver) return;
  open(by_solver(first_->play_scene(), solver));
  first_->say(fmt::format("{}: {}",
                          solver == SolverKind::projection
                              ? "large steps of liquids by a pressure projection, and of what lies in them"
                              : "explicit steps, of all matter",
                          number_text(*first_)));
}

bool SizeChooser::wants_small(const Frame& frame, double now) {
  if (frame.story != story_) {
    story_ = frame.story, began_ = now, done_ = false;
    from_ = -1;
  }
  // Whoever has begun to play keeps what is there, and whoever chose a size does.
  if (frame.can_undo || frame.size != medium_size || !frame.can_resize) done_ = true;
  if (done_) return false;
  if (frame.settings.paused || frame.settings.speed < 1 || frame.other) {
    began_ = now, from_ = -1;
    return false;
  }
  if (now - began_ < beginning) return false;
  if (from_ < 0) from_ = frame.time, measured_from_ = now;
  if (now - measured_from_ < measured) return false;
  done_ = true;
  return frame.time - from_ < too_slow * (now - measured_from_);
}

}  // namespace dreampm::play
