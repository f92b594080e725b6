// The ways in which a world can go on.
#pragma once
#include <cstdint>

namespace dreampm {

/// How a world goes on from step to step (solver/solver.h).
enum class SolverKind : std::uint8_t {
  explicit_steps,  ///< of all materials, as short as sound asks for
  projection       ///< of liquids, whose volume a pressure keeps, as long as their motion allows
};

}  // namespace dreampm
