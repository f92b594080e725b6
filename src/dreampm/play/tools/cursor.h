// The cursor in the picture: which tool its moves and buttons go to. Without a window: positions
// are in pixels from the upper left corner.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "dreampm/play/model/frame.h"
#include "dreampm/play/tools/gesture.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {

class Cursor {
 public:
  using Post = Gesture::Post;
  explicit Cursor(Post post) { gesture_.send = std::move(post); }

  const gl::Camera& camera() const { return gesture_.camera; }
  /// Looks as the scene's own pictures do.
  void reset_camera(const Frame& frame) { gesture_.camera = camera_of(frame); }

  /// `widen`: of what the camera sees, for narrow pictures.
  void resize(int width, int height, double widen = 1) {
    gesture_.width = width, gesture_.height = height, gesture_.widen = widen;
  }
  /// The camera as it is drawn by.
  gl::Camera seen_by() const { return gesture_.seen_by(); }
  /// The tool, an index into tool_names(), that counts before a frame knows of it.
  void choose(std::size_t tool) { chosen_ = tool; }
  /// It is at (x, y) at that time [s]; or outside of the picture.
  void move(const Frame& frame, double x, double y, double time);
  void leave();
  enum class Button { left, right, middle };
  /// `shift`: with the right button it turns the camera, as the left one does beside matter.
  void press(const Frame& frame, Button button, bool shift = false);
  void release(Button button);
  void wheel(double clicks);
  /// A key is held: that tool works where the cursor is, whatever tool is chosen.
  void hold(std::string_view tool, bool held);

  /// The tool that was clicked with where there was nothing for it, since the last call; else
  /// empty.
  std::string_view missed_tool() { return std::exchange(missed_, {}); }

  /// The ring, where the cursor is over the picture.
  const std::optional<CursorMark>& mark() const { return mark_; }

 private:
  Tool& tool(const Frame& frame) const;
  /// No tool hovers any more.
  void end_hover();

  Gesture gesture_;
  ToolSet tools_;
  double time_ = 0;
  std::optional<CursorMark> mark_;
  std::optional<Button> down_;
  Tool* drags_ = nullptr;              ///< of the drag under way
  Tool* hovers_ = nullptr;             ///< what moves without a button went to last
  Tool* held_ = nullptr;               ///< by a key
  std::optional<std::size_t> chosen_;  ///< absent: that of the frame
  std::string_view beside_;            ///< the tool in whose place a drag turns the view
  std::string_view missed_;
};

}  // namespace dreampm::play
