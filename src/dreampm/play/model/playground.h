// The playground without its window: a simulation, what hands do to it, and its past.
//
// Deterministic: the same actions between the same ticks give the same bits, whatever the machine's
// speed.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/play/model/action.h"
#include "dreampm/play/model/control.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/model/history.h"
#include "dreampm/simulation.h"
#include "dreampm/state/solver_kind.h"

namespace dreampm::play {

/// An index into size_names(): as a scene says.
inline constexpr std::size_t medium_size = 1;

/// What can be played: a scene, and how it is shown.
struct PlayScene {
  std::string name;
  Scene scene;
  /// Of the report: its Time Step sets the pace, and its materials begin anew where they change.
  bool report = false;
  double max_time_step = 4;  ///< 1e-4 s
  double max_hard = 4;
  std::string file{};                  ///< as load_play_scene takes it; of the report
  std::vector<std::string> presets{};  ///< of the report: their names, of which one is played
  std::size_t preset = 0;
  std::map<std::string, double> opacity{};  ///< by material, where it is not 1
  struct Window {
    int width, height;  ///< pixels
  };
  std::optional<Window> window{};  ///< that a config asks for, and the report
  std::size_t size = medium_size;  ///< index into size_names()
  std::optional<Scene> other{};    ///< the same by the other solver, of medium size, where its file has that
};

/// How many particles a stage has: small, medium as its scene says, large.
const std::vector<std::string>& size_names();
/// The stage with that many. Throws InputError for those that cannot be had otherwise: the report's
/// grid, and a scene that starts from a moment.
PlayScene resized(PlayScene stage, std::size_t size);
/// The stage of a story by its name (stories.h), or of a scene file or the report's config file.
/// `preset`: which of the config's presets, from 0. Throws InputError.
PlayScene load_play_scene(const std::string& name_or_file, std::size_t preset = 0);

struct PlayOptions {
  SimulationOptions simulation;
  std::size_t most_particles = 200000;  ///< pouring and dropping end there
  std::uint64_t history_bytes = 512ull << 20;
  /// Of the wall clock, that a step takes to where sliders hold; 0: they never do; absent: as
  /// measured.
  std::optional<double> step_seconds{};
  std::filesystem::path program;  ///< the command dreampm, which makes films; empty: none are made
};

struct Verb;

class Playground {
 public:
  /// One side: a simulation with its past. There are two while materials are compared.
  struct Impl;

  /// Throws InputError for a scene that cannot start.
  Playground(PlayScene stage, const PlayOptions& options);
  ~Playground();

  /// Throws InputError for what cannot be done; nothing is changed then. It acts from the next tick
  /// on.
  void act(const Action& action);

  /// How long a tick may last.
  struct Limit {
    std::optional<int> steps;       ///< exactly as many; or as much time as the settings ask for,
    std::optional<double> seconds;  ///< but no longer than this, of the wall clock
    /// s: instead, as much simulated time, to within a step.
    std::optional<double> simulated{};
    /// Asked between steps with the seconds of the wall clock so far, where those limit the tick:
    /// whether it ends here.
    std::function<bool(double)> ends{};
    /// Asked between steps, too: whether something else is to be done first. The tick ends, and the
    /// next one makes up for it.
    std::function<bool()> gives_way{};
  };
  /// A drawn frame's worth of time; the number of steps that it took. The second side of a
  /// comparison takes as much simulated time.
  int tick(const Limit& limit);
  /// What it looks like now. The frame stays as it is.
  std::shared_ptr<const Frame> frame();
  /// Whether what is shown shall be filmed (Frame::film).
  bool is_filmed() const;
  /// A message of whoever drives it.
  void tell(const std::string& what, bool is_error = false);
  /// Of the world; of both while materials are compared.
  std::uint64_t hash() const;
  int threads() const;
  std::string isa() const;
  const Simulation& simulation() const;
  /// Of the second side; null while nothing is compared.
  const Simulation* second_simulation() const;

  /// Another stage takes the place of what is played: an edit as others are. What is compared
  /// begins anew. Throws InputError for a scene that cannot start; nothing is changed then.
  void open(PlayScene stage);
  /// The stage begins anew with that many particles, an index into size_names(). So do those that
  /// are opened after it.
  void resize(std::size_t size);
  /// The stage begins anew, moved by that solver. Throws InputError where that cannot do it.
  void choose_solver(SolverKind solver);
  /// Starts a second side as a copy of the first. There that kind of matter, an index into
  /// matters(), takes the place of the one of which there is most; without one the materials are
  /// the same, each with its own parameters. What hands do goes to both sides from then on, but for
  /// parameters of materials, which go to the chosen side. The past begins anew, until the
  /// comparison ends. Throws InputError.
  void compare(std::optional<std::size_t> kind);
  void choose_side(bool second);
  /// The first side goes on alone. What was before the comparison can be undone and gone back to
  /// again.
  void end_comparison();

 private:
  Impl& chosen() const { return second_ && second_is_chosen_ ? *second_ : *impl_; }
  void act_on_both(const Verb& verb, const Action& action);
  void share_message();

  std::unique_ptr<Impl> impl_;
  std::unique_ptr<Impl> second_;  ///< null while nothing is compared
  bool second_is_chosen_ = false;
  std::optional<std::size_t> size_;  ///< that was asked for
  std::optional<std::size_t> compared_kind_;
  std::optional<History> before_comparison_;
};

/// A verb of the scripts. It has `run` or `run_whole`.
struct Verb {
  std::string_view name, usage, help;
  void (*run)(Playground::Impl& side, const Action& action);
  void (*run_whole)(Playground& playground, const Action& action) = nullptr;
  bool recorded = true;  ///< whether a script of what happened has it: false where it leaves the world as it is
  /// Whether `run` acts on the chosen side alone while materials are compared; null: on both.
  bool (*of_one_side)(const Action& action) = nullptr;
  /// Throws InputError where it cannot be done; asked of both sides before either acts.
  void (*check)(const Playground::Impl& side) = nullptr;

  /// The same verb with one of these.
  Verb unrecorded() const {
    Verb verb = *this;
    verb.recorded = false;
    return verb;
  }
  Verb on_one_side(bool (*when)(const Action& action)) const {
    Verb verb = *this;
    verb.of_one_side = when;
    return verb;
  }
  Verb checked_by(void (*throws)(const Playground::Impl& side)) const {
    Verb verb = *this;
    verb.check = throws;
    return verb;
  }
};
const std::vector<Verb>& verbs();

}  // namespace dreampm::play
