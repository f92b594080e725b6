// What a tool sees of the cursor, and by what it acts.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/gl/camera.h"
#include "dreampm/play/model/action.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/vec.h"

namespace dreampm::play {

/// Where a scene's own camera stands.
gl::Camera camera_of(const Frame& frame);

/// Where a ray meets what is shown.
struct Hit {
  Vec3d at;     ///< m
  bool matter;  ///< or a rigid body, or what the tool takes; else the floor, or the middle of the box
};

/// The ring of the brush in the picture.
struct CursorMark {
  Vec3f center, normal;
  float radius;
};

/// What the ray meets first: matter or a rigid body, the floor within the box, or else the plane
/// through the box's middle that faces the eye.
Hit pick(const Frame& frame, const gl::Ray& ray);

Vec3d ray_at(const gl::Ray& ray, double t);
Vec3d clamped(const Vec3d& p, const Box3d& box, double margin);

/// The cursor over the picture, whose size is in pixels.
struct Gesture {
  /// Receives what is done; gives its number (Worker::post).
  using Post = std::function<std::uint64_t(Action)>;

  Post send;
  gl::Camera camera;
  int width = 1, height = 1;
  double widen = 1;         ///< of what the camera sees, for narrow pictures
  double x = 0, y = 0;      ///< pixels from the upper left corner
  double dx = 0, dy = 0;    ///< since the last move
  double seconds = 1;       ///< since then
  std::optional<Hit> hit;   ///< under the cursor; of a drag where it was picked last
  bool is_pressed = false;  ///< whether a button is
  // Of a drag with the left button, as it began.
  bool is_drag = false;
  Vec3d from{};  ///< m
  double from_x = 0, from_y = 0;
  // Of the frame.
  Settings settings;
  double spacing = 0.02;  ///< m
  Box3d domain{}, room{};

  /// The camera as it is drawn by.
  gl::Camera seen_by() const;
  gl::Ray ray(double at_x, double at_y) const;
  gl::Ray ray() const { return ray(x, y); }
  /// Where the cursor is at the depth at which the drag began.
  Vec3d on_drag_plane() const;
  /// About what is under the cursor, or where it drags.
  std::optional<CursorMark> ring() const;
  void post(std::string verb, const std::vector<double>& numbers = {}, std::string word = {});
};

}  // namespace dreampm::play
