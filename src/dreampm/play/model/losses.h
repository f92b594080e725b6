// Matter that leaves by open walls: counted, so that nothing vanishes without a word.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "dreampm/simulation.h"

namespace dreampm::play {

/// Particles by the side of the box, in the order of Side.
using CountBySide = std::array<std::uint64_t, 6>;
/// "1,200 particles left by the top"; empty where none did.
std::string lost_text(const CountBySide& by_side);

/// What left by open walls.
struct Losses {
  CountBySide stream{};    ///< without a pause of some seconds
  CountBySide all{};       ///< since the scene was opened
  CountBySide outside{};   ///< that are beyond the walls now, and counted once they are taken out
  std::uint64_t seen = 0;  ///< gone so far, by the world's own count
  double last = 0;         ///< s of playing: when some were lost
  double began = -1;       ///< s of playing: when a message was begun about it
  std::string message{};   ///< that was said last; empty: none
  bool has_news = false;   ///< whether more left than it says

  /// Counts what left since the last call; `played`: s of playing.
  void count(const Simulation& simulation, double played);
  /// After a jump to another moment.
  void forget_stream(const Simulation& simulation);
  /// Whether so much time has passed that another message may be begun.
  bool may_begin(double played) const;
};

}  // namespace dreampm::play
