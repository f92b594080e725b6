#include "dreampm/play/model/stories.h"

#include <algorithm>
#include <array>

#include "dreampm/base/error.h"
#include "dreampm/play/model/story_files.h"

namespace dreampm::play {
namespace {

std::string_view text_of(std::string_view name) {
  const auto files = story_files();
  const auto file = std::find_if(files.begin(), files.end(), [&](const StoryFile& f) { return f.name == name; });
  if (file == files.end())
    fail_run("the story '{}' is not built into this program: scenes/play has no such file", name);
  return file->text;
}

Story story(std::string_view name, std::string_view title) { return {name, title, text_of(name)}; }

}  // namespace

std::span<const Story> stories() {
  static const std::array all{
      story("dam-break", "Dam break"),           story("honey-coil", "Honey coil"),
      story("jelly-stair", "Jelly stair"),       story("snowball", "Snowball"),
      story("hourglass", "Hourglass"),           story("dragon-rain", "Dragon rain"),
      story("floating-boxes", "Floating boxes"), story("wave-tank", "Wave tank"),
      story("toothpaste", "Toothpaste"),         story("avalanche", "Avalanche"),
  };
  return all;
}

}  // namespace dreampm::play
