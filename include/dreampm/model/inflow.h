// Emitters and sinks, through which matter comes in and goes out.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/model/motion.h"
#include "dreampm/shape.h"
#include "dreampm/vec.h"

namespace dreampm::model {

/// An emitter: its shape stays filled with matter that moves through it.
struct Emitter {
  /// Particles of two sites of a lattice keep half a spacing.
  static constexpr double most_jitter = 0.25;

  std::string name;
  std::string material;  ///< the name of one
  Shape shape{};
  std::optional<Vec3d> velocity{};  ///< m/s; or
  std::vector<Key<double>> flow{};  ///< m^3/s, along `direction`; one key: constant
  Vec3d direction{0, -1, 0};        ///< of the flow
  double swirl = 0;                 ///< rad/s about the direction through the middle of the shape
  double jitter = 0;                ///< spacings that particles are off their places along each axis at most
  double start = 0;                 ///< s
  std::optional<double> stop{};     ///< s; absent: never
  std::optional<Vec3d> color{};     ///< sRGB, 0 to 1, of what it gives; absent: the look of its material
  std::int64_t pool = 0;            ///< particles that it may give, at least 1
  bool recycle = false;             ///< true if the pool is what may be there at once, not in all
  std::optional<Motion> motion{};   ///< of its shape; velocities are those in the shape
};

/// A sink: it takes out matter that comes into its shape.
struct Sink {
  std::string name;
  Shape shape{};
  std::optional<Motion> motion{};
};

}  // namespace dreampm::model
