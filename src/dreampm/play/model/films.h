// What is made of what a playground shows: one film at a time, of whichever side is chosen.
#pragma once
#include <optional>
#include <string>

#include "dreampm/play/model/rendering.h"

namespace dreampm::play {

struct Films {
  std::optional<Rendering> rendering;
  std::string file;  ///< that what is shown is filmed into, by whoever shows it; empty: none
  double fps = 60;
};

}  // namespace dreampm::play
