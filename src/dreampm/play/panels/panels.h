// The panels of the window, by Dear ImGui: what they show comes from a frame, what they change goes
// out as actions.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/play/model/frame.h"
#include "dreampm/play/panels/panel.h"
#include "dreampm/play/panels/panel_host.h"
#include "dreampm/play/tools/cursor.h"

namespace dreampm::play {

/// How large letters and panels are in a window of that size where nobody says it: twice as large
/// in 3840 x 2160 pixels, by quarters.
float scale_of_size(int width, int height);

/// All panels (panels.cpp has their list).
class Panels {
 public:
  explicit Panels(Cursor::Post post);

  /// Between ImGui::NewFrame and ImGui::Render. `size`: of the window.
  void draw(const Frame& frame, Cursor& cursor, const DrawingFacts& facts, float width, float height);
  /// Where the picture is, in a window of that size.
  Layout layout(float width, float height) const;
  /// A tool has done something by that verb: a hint that says how is not needed any more.
  void note_use(std::string_view verb);
  /// Whether the window may close now. Where a film is under way a dialog asks first.
  bool may_close(const Frame& frame);
  /// Whether that dialog stands open.
  bool asks_to_close() const;
  /// Closes lists and menus that stand open; whether there was one.
  bool close_menus();
  /// s, from now: for how long something here changes by itself.
  double moves_for() const;
  /// Of the window with the legend: it belongs to the picture.
  static constexpr const char* legend_window = "legend";

  bool shown = true;
  PanelHost host;

 private:
  void draw_left(const PanelView& view);

  std::vector<std::unique_ptr<Panel>> panels_;
  bool was_by_keyboard_ = false;
};

/// A length that is easy to read.
struct RoundLength {
  double meters;
  std::string text;  ///< "20 cm"
};
/// The largest of 1, 2 and 5 times a power of ten that is no longer than `most` [m], which is above
/// 0.
RoundLength round_length(double most);

}  // namespace dreampm::play
