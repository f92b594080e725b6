// Shadows: what lies between the first light and the floor.
#pragma once
#include <span>

#include "dreampm/gl/look.h"
#include "dreampm/gl/mesh_store.h"

namespace dreampm::gl {

/// How the sun map lies over the floor (sun.glsl): the part of it that the domain shades.
struct SunFrame {
  Vec3f to_light;        ///< unit length, from the middle of the domain to the first light
  float low_x, low_z;    ///< m, the patch of floor
  float size_x, size_z;  ///< m
  float floor, height;   ///< m: y of the floor, and how high matter may be
  float texel;           ///< m
};
SunFrame sun_frame(const Picture& picture, int texels);

class SunMap {
 public:
  static constexpr int texels = 512, soft_texels = 256, softer_texels = 128;

  SunMap();
  /// Draws depth and blurs. Leaves its own targets bound.
  void draw(std::span<const BatchOnDevice> batches, std::span<const MeshOnDevice> meshes, const ScreenTriangle& screen);
  const Texture& depth() const { return depth_; }        ///< compares (sun.glsl)
  const Texture& darkness() const { return darkness_; }  ///< of the shadow of what is in `depth`, 0 to 1
  const Texture& soft() const { return soft_; }          ///< sun_blur.frag.glsl, a narrow blur
  const Texture& softer() const { return softer_; }      ///< and a wide one

 private:
  void draw_depth(std::span<const BatchOnDevice> batches, std::span<const MeshOnDevice> meshes);
  void blur(const Program& program, const Texture& from, const Target& to, float stride_x, float stride_y, int taps,
            const ScreenTriangle& screen);

  Texture depth_{Texel::depth, Texture::Filter::linear}, darkness_{Texel::r8, Texture::Filter::linear};
  Texture soft_half_{Texel::rg8, Texture::Filter::linear}, soft_{Texel::rg8, Texture::Filter::linear},
      softer_half_{Texel::rg8, Texture::Filter::linear}, softer_{Texel::rg8, Texture::Filter::linear};
  Target depth_target_{&darkness_, &depth_}, soft_half_target_{&soft_half_}, soft_target_{&soft_},
      softer_half_target_{&softer_half_}, softer_target_{&softer_};
  Program particles_{"sun_map.vert", "sun_map.frag"}, meshes_{"sun_mesh.vert", "sun_map.frag"},
      first_blur_{"screen.vert", "sun_blur_first.frag"}, blur_{"screen.vert", "sun_blur.frag"};
};

}  // namespace dreampm::gl
