// Places in a scene file.
#pragma once

namespace dreampm::scene {

/// Where something was said, for messages that come later (a body outside the walls): 1-based; line
/// 0: nowhere. Never part of a comparison.
struct Mark {
  int line = 0, column = 0;
  friend bool operator==(const Mark&, const Mark&) { return true; }
};

}  // namespace dreampm::scene
