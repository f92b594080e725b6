// Scenes to play with, built into the program: small enough to run while one looks at them.
#pragma once
#include <span>
#include <string_view>

namespace dreampm::play {

struct Story {
  std::string_view name;   ///< of its file in scenes/play, without the ending
  std::string_view title;  ///< for people
  std::string_view scene;  ///< the text of its file
};

/// All of them, in the order in which they are offered. They live as long as the program.
std::span<const Story> stories();

}  // namespace dreampm::play
