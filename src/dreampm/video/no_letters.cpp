// A build without Dear ImGui.
#include "dreampm/video/letters.h"

namespace dreampm {

struct Letters::Font {};
Letters::Letters() = default;
Letters::~Letters() = default;
bool Letters::there() { return false; }
int Letters::advance() const { return 1; }
int Letters::line_height() const { return 0; }
void Letters::draw(RgbImage&, int, int, std::string_view, const std::array<std::uint8_t, 3>&) const {}

}  // namespace dreampm
