// Names of files of which there is one a frame.
#pragma once
#include <fmt/format.h>

#include <string>

namespace dreampm {

/// particles_000001.ply and the like.
inline std::string numbered(const std::string& stem, int frame, const std::string& extension) {
  return fmt::format("{}_{:06}{}", stem, frame, extension);
}

}  // namespace dreampm
