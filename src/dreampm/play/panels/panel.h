// A panel of the window: one file of this folder each, and a word in the list of panels.cpp.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "dreampm/play/model/frame.h"
#include "dreampm/play/tools/cursor.h"

namespace dreampm::play {

class PanelHost;

/// What the window knows beside the frame.
struct DrawingFacts {
  double draw_ms = 0;
  double frames_a_second = 0;  ///< 0: nobody watches
  int threads = 0;
  std::string backend;  ///< with its instruction set
  std::string_view look;
  std::optional<double> film_seconds;  ///< of the film that is being made of what is drawn
  double film_behind = 0;              ///< s of it that wait for the encoder
  bool film_waits = false;             ///< whether the world stands still until there are fewer
};

/// In the pixels of ImGui.
struct Layout {
  float left = 0;    ///< the left panel's width
  float bottom = 0;  ///< the strip's height
  /// Whether panels beside the picture are shown.
  bool has_panels() const { return left > 0; }
};

/// What a panel is drawn from.
struct PanelView {
  const Frame& frame;
  Cursor& cursor;
  const DrawingFacts& facts;
  float width, height;  ///< of the window
  Layout layout;

  float picture_width() const { return width - layout.left; }
};

class Panel {
 public:
  virtual ~Panel() = default;
  /// Where it stands: in the left panel, one below the other; beside the picture where panels are
  /// shown; or over the picture.
  enum class Where { left, beside, over };
  virtual Where where() const = 0;
  /// Between ImGui::NewFrame and ImGui::Render.
  virtual void draw(const PanelView& view, PanelHost& host) = 0;

  /// A tool has done something by that verb.
  virtual void note_use(std::string_view) {}
  /// s, of the clock of ImGui: until when it changes by itself.
  virtual double changes_until() const { return 0; }
  /// Whether the window may close now; else it asks about it.
  virtual bool may_close(const Frame&) { return true; }
  virtual bool asks_to_close() const { return false; }
};

}  // namespace dreampm::play
