// Since when each particle is there.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dreampm/simulation.h"

namespace dreampm::play {

/// Ids stay with their particles. Those that were not seen before came in at the time at which they
/// are seen: after every tick.
class Ages {
 public:
  void forget() { born_.clear(); }
  void see(std::span<const std::uint32_t> ids, double time);
  /// After a jump to that time [s]: ids of what came in later are given again.
  void back_to(double time);
  /// s
  float age(std::uint32_t id, double time) const;

 private:
  static constexpr double unseen = -1;
  std::vector<double> born_;  ///< s, by id
};

/// When matter came in.
struct Arrivals {
  Ages ages;
  std::optional<std::uint32_t> seen_until{};  ///< the id of the next particle, when ages saw all; absent: they did not

  /// Notes what came in since the last call.
  void see(const Simulation& simulation);
  /// After a jump to another moment.
  void jump(const Simulation& simulation) { ages.back_to(simulation.time()), seen_until.reset(); }
};

}  // namespace dreampm::play
