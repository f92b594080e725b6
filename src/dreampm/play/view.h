// Draws frames of the playground: the picture without its panels.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

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

/// Which of some looks, from the best to the quickest, is drawn in time.
class LookLadder {
 public:
  static constexpr int rungs = 3;
  /// ms: a picture that takes longer for a while goes down a rung; one that is much quicker goes
  /// up.
  static constexpr double slow_ms = 70, quick_ms = 20;

  int rung() const { return rung_; }
  void stand_on(int rung) { rung_ = rung, pictures_ = 0; }
  /// A picture on the present rung took so long. `load`: how much there was to draw, in any unit.
  /// Goes up to a rung that was too slow only where there is less to draw now, or after a while,
  /// which doubles with each failure.
  void took(double ms, double load);

 private:
  int rung_ = 0;        ///< 0 is the best
  double mean_ms_ = 0;  ///< of late
  int pictures_ = 0;    ///< since the rung changed
  int wait_ = first_wait;
  bool tries_ = false;                                          ///< whether this rung was too slow before
  std::array<double, rungs> slow_of_{};                         ///< ms for a load of 1, where that was too slow
  static constexpr int first_wait = 300, longest_wait = 30000;  ///< pictures
};

/// Needs a current context of OpenGL from its birth to its end.
class View {
 public:
  /// Draws over all of the framebuffer.
  void draw(const Frame& frame, const gl::Camera& camera, const std::optional<HandMark>& hand,
            const gl::Framebuffer& framebuffer);
  /// Takes how long the last picture took to draw [ms]: the look `automatic` goes by that.
  void took(double ms);
  /// As in look_choices(): what was drawn last.
  std::string_view look() const;

 private:
  gl::Renderer renderer_;
  LookLadder ladder_;
  bool automatic_ = true;
  double load_ = 1;  ///< of the last picture
  /// Of the last pictures, by their places among meshes: what lies on the graphics card is known by
  /// its address, which a new mesh must not get.
  std::vector<std::shared_ptr<const TriMesh>> drawn_;
};

}  // namespace dreampm::play
