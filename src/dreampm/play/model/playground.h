// The playground without its window: a simulation, what tools do to it, and its past.
//
// Deterministic: the same actions between the same ticks give the same bits, whatever the machine's
// speed.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/model/space.h"
#include "dreampm/play/model/action.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/model/history.h"
#include "dreampm/play/model/play_scene.h"
#include "dreampm/play/model/verb.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

struct PlayOptions {
  SimulationOptions simulation;
  std::size_t most_particles = 200000;  ///< pouring and dropping end there
  std::uint64_t history_bytes = 512ull << 20;
  /// Of the wall clock, that a step takes to where sliders hold; 0: they never do; absent: as
  /// measured.
  std::optional<double> step_seconds{};
  std::filesystem::path program;  ///< the command dreampm, which makes films; empty: none are made
};

struct PlayModel;
struct Verb;

class Playground {
 public:
  /// Throws InputError for a scene that cannot start.
  Playground(PlayScene scene, const PlayOptions& options);
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
  std::string backend() const;  ///< with its instruction set, as in "cpu, avx2"
  const Simulation& simulation() const;
  /// Of the second side; null while nothing is compared.
  const Simulation* second_simulation() const;

  /// Another scene takes the place of what is played: an edit as others are. What is compared
  /// begins anew. Throws InputError for a scene that cannot start; nothing is changed then.
  void open(PlayScene scene);
  /// The scene begins anew with that many particles, an index into size_names(). So do those that
  /// are opened after it.
  void resize(std::size_t size);
  /// The scene begins anew, moved by that solver. Throws InputError where that cannot do it.
  void choose_solver(SolverKind solver);
  /// Starts a second side as a copy of the first. There that kind of matter, an index into
  /// matters(), takes the place of the one of which there is most; without one the materials are
  /// the same, each with its own parameters. What tools do goes to both sides from then on, but for
  /// parameters of materials, which go to the chosen side. The past begins anew, until the
  /// comparison ends. Throws InputError.
  void compare(std::optional<std::size_t> kind);
  void choose_side(bool second);
  /// The first side goes on alone. What was before the comparison can be undone and gone back to
  /// again.
  void end_comparison();

 private:
  PlayModel& chosen() const;
  void act_on_both(const Verb& verb, const Action& action);
  void share_message();

  /// A second side beside the first.
  struct Comparison {
    std::unique_ptr<PlayModel> second;
    History before;                   ///< of the first side, until then
    std::optional<std::size_t> kind;  ///< that was asked for
    bool second_is_chosen = false;
  };
  std::unique_ptr<PlayModel> first_;
  std::optional<Comparison> comparison_;
  std::optional<std::size_t> size_;  ///< that was asked for
  std::uint64_t actions_ = 0;        ///< done so far
};

}  // namespace dreampm::play
