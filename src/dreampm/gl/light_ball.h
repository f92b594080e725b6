// The light of a frame, by normal.
#pragma once
#include "dreampm/gl/objects.h"

namespace dreampm::gl {

/// Where spheres look up their light: one texel a normal, one tile for each share of the first
/// light that arrives (light_ball.frag.glsl). A software driver takes half the time over a texel
/// that it takes over the lamps.
class LightBall {
 public:
  LightBall();
  /// Of the frame whose uniform block is bound. Leaves its own target bound.
  void draw(const ScreenTriangle& screen);
  const Texture& texture() const { return texture_; }

 private:
  static constexpr int side = 64, levels = 8;  // spheres.vert.glsl and spheres.frag.glsl count on them
  Texture texture_{Texel::rgba8, Texture::Filter::nearest};
  Target target_{&texture_};
  Program program_{"screen.vert", "light_ball.frag"};
};

}  // namespace dreampm::gl
