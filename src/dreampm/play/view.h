// Draws frames of the playground: the picture without its panels.
#pragma once
#include <memory>
#include <optional>
#include <string_view>

#include "dreampm/gl/renderer.h"
#include "dreampm/play/frame.h"

namespace dreampm::play {

/// Where a scene's own camera stands.
gl::Camera camera_of(const Frame& frame);

/// What the hand shows in the picture.
struct HandMark {
  Vec3f center, normal;
  float radius;
};

/// Needs a current context of OpenGL from its birth to its end.
class View {
 public:
  /// Draws over all of the framebuffer.
  void draw(const Frame& frame, const gl::Camera& camera, const std::optional<HandMark>& hand,
            const gl::Framebuffer& framebuffer);
  /// Takes how long a picture took to draw [ms]: the look `automatic` goes by that.
  void took(double ms);
  /// As in look_choices(): what was drawn last.
  std::string_view look() const;

 private:
  gl::Renderer renderer_;
  int level_ = 0;        ///< into the ladder of looks, 0 is the best
  double drawn_ms_ = 0;  ///< of late
  int frames_ = 0;       ///< since the level changed
  bool automatic_ = true;
};

}  // namespace dreampm::play
