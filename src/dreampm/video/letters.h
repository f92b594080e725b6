// Letters on pictures.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "dreampm/image.h"

namespace dreampm {

/// One font of fixed width, the same on every machine: ProggyClean, which Dear ImGui brings along.
/// ASCII; other characters are shown as "?".
class Letters {
 public:
  Letters();
  ~Letters();
  Letters(const Letters&) = delete;
  Letters& operator=(const Letters&) = delete;

  /// Whether this build has letters; without them text takes no room and draws nothing.
  static bool there();
  int advance() const;      ///< pixels from a letter to the next
  int line_height() const;  ///< pixels from a line to the next
  /// The text with its upper left corner at (x, y); what reaches beyond the picture is cut off.
  void draw(RgbImage& picture, int x, int y, std::string_view text, const std::array<std::uint8_t, 3>& color) const;

 private:
  struct Font;
  std::unique_ptr<Font> font_;
};

}  // namespace dreampm
