// How Dear ImGui's panels look.
#pragma once
#include <string>

namespace dreampm::play {

/// A font that is easier to read than ImGui's own: the machine's, else the one that an archive
/// brought along with the command. Empty where there is none.
std::string font_file();

/// Colors, and sizes at a scale of 1.
void set_style(bool dark);

}  // namespace dreampm::play
