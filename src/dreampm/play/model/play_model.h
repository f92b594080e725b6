// One side of a playground: a simulation, its past, and what is remembered beside it. There are two
// while materials are compared.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/play/model/films.h"
#include "dreampm/play/model/history.h"
#include "dreampm/play/model/live_foam.h"
#include "dreampm/play/model/play_state.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/readback.h"

namespace dreampm::play {

/// Ticks are drawn frames.
inline constexpr double ticks_a_second = 60;

struct ReportLook;

struct PlayModel : PlayState {
  PlayModel(PlayScene first, const PlayOptions& options);

  const PlayScene& play_scene() const { return loaded->scene; }

  // ---- the scene

  /// A scene with its simulation, in which tools have put what was saved of them.
  struct Begun {
    PlayScene scene;
    Simulation simulation;
  };
  /// Throws InputError for a scene that cannot start.
  Begun begin(PlayScene scene) const;
  void open(Begun next);
  /// Makes the simulation one of that scene, and forgets what tools did.
  void enter(std::shared_ptr<const LoadedScene> what, Simulation its_simulation);
  void restart();

  // ---- the past

  StateSnapshot moment() const { return {loaded, simulation->snapshot(), settings, clock.played}; }
  void go_to(const StateSnapshot& moment);
  /// After a jump to another moment: what tools had begun has ended.
  void end_tools();
  /// Keeps what is now for undo.
  void before_edit(const std::string& what) {
    history.before_edit(what, [this] { return moment(); });
  }
  /// The same for an edit that is one by itself.
  void before_own_edit(const std::string& what) {
    history.separate();
    before_edit(what);
    history.separate();
  }
  void say(std::string text, bool is_error = false) { message = {std::move(text), is_error, message.number + 1}; }

  // ---- the tick

  /// s of simulated time that a tick asks for
  double asked_seconds() const;
  /// Steps that it took. Where numbers stop being numbers the world jumps back.
  int tick(const Playground::Limit& limit);
  /// Steps of a tick, as far as the limit goes; their number.
  int advance(const Playground::Limit& limit);
  /// Gravity, the length of large steps, and what tools do in a tick of that length [s].
  void apply_settings_and_tools(double seconds);
  /// Moves the materials on to what was asked for.
  void approach_targets();
  /// Says what left by open walls; a message about it counts on while it is the last one.
  void say_losses();
  /// Goes back from what went wrong in a tick that began at that step; the steps that it took.
  int fail(std::uint64_t before_steps, const std::string& why);
  void jump(Jump where, const std::string& why);

  // ---- materials and settings

  /// Lists the controls anew, where the materials of the scene are others.
  void list_controls();
  /// Throws InputError for a control that there is not, and a value that it cannot have.
  void set(const std::string& id, double value);
  /// Sets what makes a look of the report's material. Throws InputError in other scenes.
  void set_report_look(const ReportLook& look);
  /// The name of the material of that kind; the scene gets it where it has none.
  std::string ensure_matter(std::size_t kind);

  PlayOptions options;
  std::shared_ptr<const LoadedScene> loaded;
  std::optional<Simulation> simulation;
  History history;
  std::shared_ptr<Films> films = std::make_shared<Films>();
  FrameReader frames;
  LiveFoam foam;  ///< begins anew at each jump

  // What follows from the scene, its materials and the solver.
  std::shared_ptr<const std::vector<ControlInfo>> controls;
  std::vector<std::string> refusals;  ///< of each kind of matter by the solver; empty: it can do with it
  std::string no_other;               ///< why the scene cannot be moved by the other solver; empty: it can
};

}  // namespace dreampm::play
