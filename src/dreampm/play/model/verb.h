// Verbs of the scripts: what can be done in a playground.
#pragma once
#include <string_view>
#include <vector>

#include "dreampm/play/model/action.h"

namespace dreampm::play {

class Playground;
struct PlayModel;

/// A verb of the scripts. It has `run` or `run_whole`.
struct Verb {
  std::string_view name, usage, help;
  void (*run)(PlayModel& side, const Action& action);
  void (*run_whole)(Playground& playground, const Action& action) = nullptr;
  bool recorded = true;  ///< whether a script of what happened has it: false where it leaves the world as it is
  bool passes = false;   ///< a cursor that only moves does it: a record that is played again goes on over it
  /// Whether `run` acts on the chosen side alone while materials are compared; null: on both.
  bool (*of_one_side)(const Action& action) = nullptr;
  /// Throws InputError where it cannot be done; asked of both sides before either acts.
  void (*check)(const PlayModel& side) = nullptr;

  /// The same verb with one of these.
  Verb unrecorded() const {
    Verb verb = *this;
    verb.recorded = false;
    return verb;
  }
  Verb by_passing() const {
    Verb verb = *this;
    verb.passes = true;
    return verb;
  }
  Verb on_one_side(bool (*when)(const Action& action)) const {
    Verb verb = *this;
    verb.of_one_side = when;
    return verb;
  }
  Verb checked_by(void (*throws)(const PlayModel& side)) const {
    Verb verb = *this;
    verb.check = throws;
    return verb;
  }
};
/// Those of the playground (verbs.cpp), and those of its tools.
const std::vector<Verb>& verbs();

}  // namespace dreampm::play
