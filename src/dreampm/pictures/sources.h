// Where each particle came from: the emitter or body, and when.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/setup/assemble.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The emitters and bodies of a world. They are counted together from 0, the emitters first, so
/// that a body that comes in later changes no number.
class Sources {
 public:
  template <class R>
  Sources(const World<R>& world, const std::vector<BodyRange>& bodies);

  struct Source {
    int number = -1;   ///< -1: unknown, such as matter from the file of a moment
    double since = 0;  ///< s, when the particle came in
  };
  Source of(std::uint32_t particle) const;
  /// By number.
  const std::vector<std::string>& names() const { return names_; }
  /// sRGB, by number.
  const std::vector<std::optional<Vec3d>>& colors() const { return colors_; }

 private:
  struct Range {
    std::uint64_t first, end;  ///< ids
    Source source;
  };
  std::vector<Range> ranges_;  ///< by rising ids
  std::vector<std::string> names_;
  std::vector<std::optional<Vec3d>> colors_;
};

}  // namespace dreampm
