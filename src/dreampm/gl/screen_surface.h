// A smooth surface around particles, found in screen space at half the size of the picture.
#pragma once
#include "dreampm/gl/look.h"
#include "dreampm/gl/patch.h"

namespace dreampm::gl {

/// Distance and thickness by particles as spheres, smoothed by the filter of N. Truong and C.
/// Yuksel, "A Narrow-Range Filter for Screen-Space Fluid Rendering" (2018).
class ScreenSurface {
 public:
  /// Draws the batch and filters; false where nothing of it can be seen. Leaves its own targets
  /// bound, depth test off, and the scissor test on, at patch() of the frame.
  bool find(const FrameContext& frame, const BatchOnDevice& batch);
  /// The mean color of the particles at the surface, for batches that have colors by particle.
  void find_colors(const BatchOnDevice& batch);

  float far() const { return far_; }                   ///< m: what `field` counts from
  const Patch& patch() const { return patch_; }        ///< where it can be seen, in pixels of the frame
  const Texture& field() const { return filtered_; }   ///< surface_clean.frag.glsl
  const Texture& normals() const { return normals_; }  ///< surface_normal.frag.glsl
  const Texture& colors() const { return colors_; }    ///< surface_color.frag.glsl

 private:
  void set_corners(const Program& program) const;
  void splat(const BatchOnDevice& batch, float radius);
  void filter(const Texture& from, const Target& to, int x, int y, float radius, const ScreenTriangle& screen);
  void clean(float radius, const ScreenTriangle& screen);

  float far_ = 0;
  int tap_distance_ = 1;                   ///< of the filter, in texels of `field`
  int spread_near_ = 1, spread_away_ = 2;  ///< pixels of the half-size picture (surface_filter.frag.glsl)
  Patch patch_, half_;
  Texture front_{Texel::rgba32f, Texture::Filter::linear}, filtered_{Texel::rgba32f, Texture::Filter::linear};
  Texture normals_{Texel::rgba16f, Texture::Filter::linear}, colors_{Texel::rgba16f, Texture::Filter::linear};
  Target front_target_{&front_}, filtered_target_{&filtered_}, normals_target_{&normals_}, colors_target_{&colors_};
  Program splat_{"surface_splat.vert", "surface_splat.frag"}, filter_{"screen.vert", "surface_filter.frag"},
      clean_{"screen.vert", "surface_clean.frag"}, normal_{"screen.vert", "surface_normal.frag"},
      color_{"surface_color.vert", "surface_color.frag"};
};

}  // namespace dreampm::gl
