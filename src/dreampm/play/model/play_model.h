// One side of a playground: a simulation, its past, and what is remembered beside it. There are two
// while materials are compared.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/play/model/history.h"
#include "dreampm/play/model/play_state.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/rendering.h"

namespace dreampm::scene {
struct Look;
}

namespace dreampm::play {

/// Ticks are drawn frames.
inline constexpr double ticks_a_second = 60;

/// How a scene is saved.
struct SavedAs {
  bool finer = false;             ///< at half the spacing, each particle as eight
  std::optional<double> seconds;  ///< that it lasts; absent: as long as the scene it came from
  /// From where it is seen; absent: from where that was.
  struct Seen {
    Vec3d from, to;  ///< m
    double fov;      ///< degrees
  };
  std::optional<Seen> seen;
};

/// What is made of what is shown: one film at a time, of whichever side is chosen.
struct Films {
  std::optional<Rendering> rendering;
  std::string file;  ///< that what is shown is filmed into, by whoever shows it; empty: none
  double fps = 60;
};

struct ReportLook;

/// How matter looks whose scene says so.
MatterLook look_of(const model::Look& look);

struct PlayModel : PlayState {
  PlayModel(PlayScene first, const PlayOptions& options);

  const PlayScene& play_scene() const { return loaded->scene; }

  // play_model.cpp
  /// A scene with its simulation, in which tools have put what was saved of them.
  struct Begun {
    PlayScene scene;
    Simulation simulation;
  };
  /// Throws InputError for a scene that cannot start.
  Begun begin(PlayScene scene) const;
  void open(Begun next);
  /// Makes the simulation one of that scene, and forgets what tools did.
  void enter(std::shared_ptr<const LoadedScene> what, Simulation fresh);
  void restart();
  /// After a jump to another moment: what tools had begun has ended.
  void end_tools();
  StateSnapshot moment() const { return {loaded, simulation->snapshot(), settings, clock.played}; }
  void go_to(const StateSnapshot& moment);
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
  /// s of simulated time that a tick asks for
  double asked_seconds() const;
  int advance(const Playground::Limit& limit);
  /// Steps that it took. Where numbers stop being numbers the world jumps back.
  int tick(const Playground::Limit& limit);
  /// Gravity, the length of large steps, and what tools do in a tick of that length [s].
  void apply_settings_and_tools(double seconds);
  /// Goes back from what went wrong in a tick that began at that step; the steps that it took.
  int fail(std::uint64_t before_steps, const std::string& why);
  void jump(Jump where, const std::string& why);

  // materials.cpp
  /// Lists the controls anew, where the materials of the scene are others.
  void list_controls();
  double value_of(const ControlInfo& control);
  /// Of all controls, as they were asked for: what is under way is at its end.
  std::vector<double> asked_values();
  /// Says where elastic matter has become too soft for what presses on it, which it was not as all
  /// was set before.
  void see_softness(const std::vector<double>& before);
  void set(const std::string& id, double value);
  /// A parameter of a material, by the id of its control, at once.
  void set_material(const std::string& id, double value);
  /// Of the report's material.
  void take_look(const ReportLook& look);
  /// Moves the materials on to what was asked for, no faster than the matter can take.
  void approach_targets();
  /// The name of the material of that kind; the scene gets it where it has none.
  std::string ensure_matter(std::size_t kind);
  std::vector<std::string> facts() const;
  /// The member of a look that a control of a material sets; null for other controls.
  float* look_member(const std::string& id);
  std::string remedy() const;

  // compare.cpp
  /// Goes on where `other` is, but for its past, with that kind of matter in place of its main one.
  void copy(const PlayModel& other, std::optional<std::size_t> kind);
  /// The material of which there is most.
  std::string main_material() const;
  /// Tools have the matter of the scene, and what it is compared with is another.
  void choose_matter();
  /// That kind of matter takes the place of the material `stand_in_for`.
  void put_stand_in();

  // losses.cpp
  /// Says what left since the last call.
  void see_losses();
  /// After a jump to another moment.
  void forget_losses();

  // save.cpp
  /// A scene file, and beside it the moment that it starts from.
  void save(const std::filesystem::path& file, const SavedAs& as = {});
  /// Saves a finer scene and begins an estimate of its film, or the film itself: the words of the
  /// verbs `estimate` and `render`.
  void render(const Action& action, bool goes_on);

  // readback.cpp
  /// Notes what came in since the last call.
  void see_new_matter();
  void read(Frame& frame);
  std::shared_ptr<Frame> frame();

  PlayOptions options;
  std::shared_ptr<const LoadedScene> loaded;
  std::optional<Simulation> simulation;
  History history;
  std::shared_ptr<Films> films = std::make_shared<Films>();
  std::uint64_t actions = 0;

  // What follows from the scene, its materials and the solver.
  std::shared_ptr<const std::vector<ControlInfo>> controls;
  std::vector<std::string> refusals;  ///< of each kind of matter by the solver; empty: it can do with it
  std::string no_other;               ///< why the scene cannot be moved by the other solver; empty: it can
  std::vector<BodyFrame> bodies;      ///< where the scene has them

  /// Of the controls `of`, as they were at the tick `at`.
  struct Live {
    std::vector<LiveRange> ranges;
    std::shared_ptr<const std::vector<ControlInfo>> of;
    std::uint64_t at = 0;
  } live;
  std::vector<std::shared_ptr<Frame>> frames;  ///< that were given away, to be used again
};

}  // namespace dreampm::play
