// Draws frames of the playground: the picture without its panels.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "dreampm/gl/renderer.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/tools/gesture.h"

namespace dreampm::play {

/// Which of some looks, from the best to the quickest, is drawn in time.
class LookLadder {
 public:
  static constexpr int rungs = 3;
  /// ms: pictures that take longer for a while go down a rung.
  static constexpr double slow_ms = 70;
  /// s: that while.
  static constexpr double patience = 1.5;

  int rung() const { return rung_; }
  void stand_on(int rung);
  /// A picture on the present rung took so long, and the one before was shown for `seconds`.
  /// `load`: how much there was to draw, in any unit. Goes up to a rung that will be in time by
  /// what it took when it was left, beside the present one then and by itself; and else after a
  /// while, which doubles with each failure. A rung down that gains nothing is taken back.
  void took(double ms, double load, double seconds);

 private:
  void go_to(int rung);
  /// ms, that the next better rung would take; 0: unknown.
  double expected(double load) const;

  int rung_ = 0;         ///< 0 is the best
  double mean_ms_ = 0;   ///< of late
  int pictures_ = 0;     ///< since the rung changed
  double stood_ = 0;     ///< s, since then
  double slow_for_ = 0;  ///< s
  double stays_ = 0;     ///< s, for which a rung down is known to gain nothing
  int left_rung_ = 0;    ///< the rung that was left for a quicker one
  double left_ms_ = 0;   ///< what it took, until that is judged
  bool tries_ = false;   ///< whether this rung was too slow before
  double wait_ = first_wait;
  std::array<double, rungs> cost_{};   ///< ms for a load of 1, of late; 0: never seen
  std::array<double, rungs> ratio_{};  ///< how much longer than the next quicker one; 0: unknown
  static constexpr double first_wait = 10, longest_wait = 300;  ///< s
};

/// Needs a current context of OpenGL from its birth to its end.
class View {
 public:
  /// Draws over all of the framebuffer.
  void draw(const Frame& frame, const gl::Camera& camera, const std::optional<CursorMark>& mark,
            const gl::Framebuffer& framebuffer);
  /// Takes how long the last picture took to draw [ms], and for how long the one before was shown
  /// [s]: the look `automatic` goes by that, and where nobody says it, it is the best.
  void took(double ms, double seconds);
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
