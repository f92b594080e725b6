// The files of scenes/play, as they were when this was built.
#pragma once
#include <span>
#include <string_view>

namespace dreampm::play {

struct StoryFile {
  std::string_view name;  ///< of the file, without its ending
  std::string_view text;
};
std::span<const StoryFile> story_files();

}  // namespace dreampm::play
