#include "dreampm/video/letters.h"

#include <imgui.h>

#include <cmath>

namespace dreampm {

/// The letters of the font in one picture of gray values.
struct Letters::Font {
  ImFontAtlas atlas;
  ImFont* font = nullptr;
  unsigned char* values = nullptr;
  int width = 0, height = 0;
};

Letters::Letters() : font_(std::make_unique<Font>()) {
  font_->atlas.Flags |= ImFontAtlasFlags_NoMouseCursors | ImFontAtlasFlags_NoBakedLines;
  font_->font = font_->atlas.AddFontDefault();
  font_->atlas.GetTexDataAsAlpha8(&font_->values, &font_->width, &font_->height);
}
Letters::~Letters() = default;

bool Letters::there() { return true; }
int Letters::advance() const { return static_cast<int>(std::lround(font_->font->FindGlyph('0')->AdvanceX)); }
int Letters::line_height() const { return static_cast<int>(std::lround(font_->font->FontSize)) + 1; }

void Letters::draw(RgbImage& picture, int x, int y, std::string_view text,
                   const std::array<std::uint8_t, 3>& color) const {
  const int step = advance();
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c & 0xc0) == 0x80) continue;  // within a character of several bytes
    const ImFontGlyph& g = *font_->font->FindGlyph(c < 0x80 ? c : '?');
    const int left = x + static_cast<int>(std::lround(g.X0)), top = y + static_cast<int>(std::lround(g.Y0));
    const int from_x = static_cast<int>(std::lround(g.U0 * static_cast<float>(font_->width)));
    const int from_y = static_cast<int>(std::lround(g.V0 * static_cast<float>(font_->height)));
    const int w = static_cast<int>(std::lround(g.X1 - g.X0)), h = static_cast<int>(std::lround(g.Y1 - g.Y0));
    for (int v = 0; v < h; ++v)
      for (int u = 0; u < w; ++u) {
        const int px = left + u, py = top + v;
        if (px < 0 || py < 0 || px >= picture.width || py >= picture.height) continue;
        const int share = font_->values[(from_y + v) * font_->width + from_x + u];
        std::uint8_t* to = picture.at(px, py);
        for (std::size_t k = 0; k < 3; ++k)
          to[k] = static_cast<std::uint8_t>((to[k] * (255 - share) + color[k] * share + 127) / 255);
      }
    x += step;
  }
}

}  // namespace dreampm
