// The files of scenes/play and scenes/play/pictures, as they were when this was built.
#pragma once
#include <span>
#include <string_view>

namespace dreampm::play {

struct StoryFile {
  std::string_view name;  ///< of the file, without its ending
  std::string_view text;
};
std::span<const StoryFile> story_files();

struct PictureFile {
  std::string_view name;                 ///< of the file, without its ending
  std::span<const unsigned char> bytes;  ///< of a PNG
};
std::span<const PictureFile> picture_files();

}  // namespace dreampm::play
