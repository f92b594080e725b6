// What one side of a playground remembers beside its simulation: plain values, which can be copied.
// They stand in one list, with when each of them begins anew: a member that is not in it does not
// compile.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>

#include "dreampm/play/model/ages.h"
#include "dreampm/play/model/control.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/model/losses.h"
#include "dreampm/play/model/material_controls.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/vec.h"

namespace dreampm::play {

/// Where the world went in a tick that went wrong.
enum class Jump { none, back, anew };

/// How time goes on.
struct Clock {
  double played = 0;            ///< s of playing, which going back takes back
  double pending = 0;           ///< s of simulated time that were asked for and are not done
  Jump last_jump = Jump::none;  ///< in the last tick
  bool single_step = false;
  bool restart_is_due = false;
  int failures = 0;  ///< since matter last moved well
  std::uint64_t ticks = 0;
};

/// s of the wall clock, that a step takes.
struct StepCost {
  double latest = 1e-3;
  double mean = 0;  ///< over about a second; 0: none was taken
};

/// The last thing that was refused, mended or saved.
struct Message {
  std::string text{};
  bool is_error = false;
  std::uint64_t number = 0;   ///< counts messages
  std::uint64_t changes = 0;  ///< of the text of this one: what it counts has become more

  bool is_older_than(const Message& other) const {
    return number != other.number ? number < other.number : changes < other.changes;
  }
};

/// While materials are compared: what this side is called after, and the kind of matter that is
/// there instead of another material.
struct ComparedMatter {
  std::string main{}, replaced{};
  std::optional<std::size_t> replacement{};
};

struct PlayState {
  Settings settings;
  Clock clock;
  Targets targets;
  Looks looks;
  Vec3d gravity{};  ///< m/s^2, that the simulation has
  ToolSet tools;
  Losses losses;
  Arrivals arrivals;
  ComparedMatter compared;
  Meters meters;
  StepCost cost;
  Message message;
};

/// When a member of a PlayState begins anew by itself.
struct PlayFieldUse {
  bool opens = false;  ///< where another scene is opened
  bool jumps = false;  ///< where undo, redo and rewind go to another moment
  bool ends = false;   ///< where what tools had begun ends: at each jump, and as sides are compared
};

namespace play_use {
inline constexpr PlayFieldUse stays{};
inline constexpr PlayFieldUse of_scene{.opens = true};
inline constexpr PlayFieldUse under_way{.opens = true, .jumps = true};
inline constexpr PlayFieldUse of_tick{.opens = true, .ends = true};
/// PlayModel finds it anew itself, by the simulation.
inline constexpr PlayFieldUse found{};
}  // namespace play_use

template <PlayFieldUse of, class T>
struct PlayField {
  static constexpr PlayFieldUse use = of;
  T& value;
};

template <PlayFieldUse use, class T>
PlayField<use, T> play_field(T& value) {
  return {value};
}

/// All of a PlayState, const or not.
template <class State>
  requires std::is_same_v<std::remove_const_t<State>, PlayState>
auto fields_of(State& state) {
  using namespace play_use;
  auto& [settings, clock, targets, looks, gravity, tools, losses, arrivals, compared, meters, cost, message] = state;
  auto& [played, pending, last_jump, single_step, restart_is_due, failures, ticks] = clock;
  return std::tuple{
      play_field<stays>(settings),    play_field<found>(played),         play_field<of_tick>(pending),
      play_field<stays>(last_jump),   play_field<of_scene>(single_step), play_field<of_scene>(restart_is_due),
      play_field<of_scene>(failures), play_field<stays>(ticks),          play_field<under_way>(targets),
      play_field<of_scene>(looks),    play_field<found>(gravity),        play_field<of_scene>(tools),
      play_field<of_scene>(losses),   play_field<of_scene>(arrivals),    play_field<stays>(compared),
      play_field<stays>(meters),      play_field<stays>(cost),           play_field<stays>(message)};
}

/// Makes the members that begin anew then what they are at first.
template <bool PlayFieldUse::* when>
void begin_anew(PlayState& state) {
  std::apply(
      [](const auto&... field) {
        const auto one = [](const auto& f) {
          if constexpr (f.use.*when) f.value = {};
        };
        (one(field), ...);
      },
      fields_of(state));
}

}  // namespace dreampm::play
