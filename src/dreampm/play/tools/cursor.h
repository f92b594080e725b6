// The hand in the picture: what its moves and buttons mean there. Without a window: positions are
// in pixels from the upper left corner.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dreampm/gl/camera.h"
#include "dreampm/play/model/action.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/window/view.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// Where a ray meets what is shown.
struct Hit {
  Vec3d at;     ///< m
  bool matter;  ///< or a rigid body; else the floor, or the middle of the box
};

/// What the ray meets first: matter or a rigid body, the floor within the box, or else the plane
/// through the box's middle that faces the eye.
Hit pick(const Frame& frame, const gl::Ray& ray);
/// Where what is dropped over such a place begins to fall: high in the box, all of it within.
Vec3d above(const Hit& hit, const Box3d& domain, double size, double spacing);

/// Spacings: how long one of drop_names() is at least where the tool drops it. The shape of a mesh
/// would be crumbs at fewer.
double least_drop(const std::string& name);

class Cursor {
 public:
  /// Receives what the hand does; gives its number (Worker::post).
  using Post = std::function<std::uint64_t(Action)>;
  explicit Cursor(Post post) : post_(std::move(post)) {}

  gl::Camera camera;
  /// Looks as the scene's own pictures do.
  void reset_camera(const Frame& frame) { camera = camera_of(frame); }

  /// `widen`: of what the camera sees, for narrow pictures.
  void resize(int width, int height, double widen = 1) { width_ = width, height_ = height, widen_ = widen; }
  /// The camera as it is drawn by.
  gl::Camera seen_by() const;
  /// The tool, an index into tool_names(), that counts before a frame knows of it.
  void choose(std::size_t tool) { chosen_ = tool; }
  /// The pointer is at (x, y) at that time [s]; or outside of the picture.
  void move(const Frame& frame, double x, double y, double time);
  void leave();
  enum class Button { left, right, middle };
  /// `shift`: with the right button it turns the camera, as the left one does beside matter.
  void press(const Frame& frame, Button button, bool shift = false);
  void release(Button button);
  void wheel(double clicks);
  /// While held, matter is poured where the pointer is.
  void hold_pour(const Frame& frame, bool held);

  /// The tool that was clicked with where there was nothing for it, since the last call; else
  /// empty.
  std::string_view take_missed() { return std::exchange(missed_, {}); }

  /// The ring, where the pointer is over the picture.
  const std::optional<CursorMark>& mark() const { return mark_; }

 private:
  struct Tool;
  static const std::vector<Tool>& tools();
  const Tool& tool(const Frame& frame) const;
  static const Tool& tool(std::string_view name);
  /// What it takes hold of with this tool.
  Hit pick_for(const Tool& tool, const Frame& frame, const gl::Ray& ray);
  void draw_wall();
  /// Where the pointer is at the height at which a jet began: what is poured is not aimed at.
  Vec3d on_pour_plane() const;
  void begin_pour();
  void pour();
  /// Where the pointer is at the depth at which a drag began.
  Vec3d on_drag_plane() const;
  void post(std::string verb, std::vector<double> numbers, std::string word = {});

  Post post_;
  int width_ = 1, height_ = 1;
  double widen_ = 1;
  double x_ = 0, y_ = 0, last_x_ = 0, last_y_ = 0, time_ = 0;
  std::optional<CursorMark> mark_;
  std::optional<Hit> hit_, last_hit_;
  Vec3d velocity_{};          ///< m/s, of the hand
  std::optional<Side> wall_;  ///< under the pointer, or dragged
  double radius_ = 0.08, spacing_ = 0.02;
  Box3d domain_{}, room_{};
  std::optional<Button> down_;
  bool drags_matter_ = false, orbits_ = false, pours_ = false, pushed_ = false;
  Vec3d drag_from_{};  ///< m: where the drag began
  double drag_x_ = 0, drag_y_ = 0;
  const Tool* tool_ = nullptr;         ///< of the drag
  std::optional<std::size_t> chosen_;  ///< absent: that of the frame
  std::string_view missed_;
  std::optional<Vec3d> pour_at_;  ///< m: what the jet is poured onto
  std::string drop_ = "box";
};

}  // namespace dreampm::play
