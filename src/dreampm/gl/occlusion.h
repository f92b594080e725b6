// Ambient occlusion in screen space, of all opaque matter.
#pragma once
#include "dreampm/gl/framebuffer.h"
#include "dreampm/gl/objects.h"
#include "dreampm/gl/patch.h"

namespace dreampm::gl {

class Occlusion {
 public:
  /// Darkens a patch of the framebuffer where matter within `reach` [m] takes the light of the sky.
  /// Leaves the framebuffer bound.
  void apply(const Framebuffer& framebuffer, const Patch& patch, float reach, const ScreenTriangle& screen);

 private:
  Texture raw_{Texel::r8, Texture::Filter::nearest}, smooth_{Texel::r8, Texture::Filter::linear};
  Target raw_target_{&raw_}, smooth_target_{&smooth_};
  Program find_{"occlusion.vert", "occlusion.frag"}, blur_{"occlusion.vert", "occlusion_blur.frag"},
      apply_{"screen.vert", "occlusion_apply.frag"};
};

}  // namespace dreampm::gl
