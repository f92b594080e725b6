// How particles look: one object a look. A new one is a class of its own and a line in looks.cpp.
#pragma once
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "dreampm/gl/camera.h"
#include "dreampm/gl/framebuffer.h"
#include "dreampm/gl/objects.h"
#include "dreampm/gl/picture.h"

namespace dreampm::gl {

/// When a look draws.
enum class Stage {
  solid,    ///< before the ground, with depth
  blended,  ///< over the ground, with depth and soft outlines
  liquid,   ///< over all opaque matter, which it may read through the framebuffer's textures
  over,     ///< over liquids
};

/// A batch, and the vertex array that holds its particles: position, value and color are inputs 0,
/// 1 and 2 (particle.glsl).
struct BatchOnDevice {
  const ParticleBatch* batch;
  const VertexArray* vertices;
  int count;
  /// How many of them are in the vertex array's indices, the nearest first; 0 where the look has
  /// not asked for it.
  int ordered_count;
  Box3f bounds;  ///< of the centers; empty without particles
  /// Some of them, evenly chosen, and by how much wider they are to fill the same space: for
  /// shadows.
  const VertexArray* thinned;
  int thinned_count;
  float thinned_radius;
  Stage stage;  ///< of its look; blended where the batch lets light through
};

/// What the passes of a frame share. The uniform block Frame (frame.glsl) is bound.
struct FrameContext {
  const Camera* camera;
  const Framebuffer* framebuffer;
  const Texture *sun_map, *sun_darkness;  ///< sun.glsl, sun_map.frag.glsl
  const Texture* light_ball;              ///< light_ball.frag.glsl
  const ScreenTriangle* screen;
};

class Look {
 public:
  virtual ~Look() = default;
  virtual std::string_view name() const = 0;
  virtual Stage stage() const { return Stage::solid; }
  /// Near particles hide far ones: they are wanted in that order.
  virtual bool wants_order() const { return false; }
  /// Shading by ambient occlusion is wanted where this is drawn.
  virtual bool wants_occlusion() const { return false; }
  /// Called with what lies behind liquids drawn, and the edges of the domain not yet: a look that
  /// shows what is behind it keeps it. Leaves all as draw() does.
  virtual void keep_behind(const FrameContext&) {}
  /// Draws the batches of this look; there is at least one. The framebuffer is bound, with depth
  /// test and writes on, and is to be left so.
  virtual void draw(const FrameContext& frame, std::span<const BatchOnDevice> batches) = 0;
};

/// All looks there are.
std::vector<std::unique_ptr<Look>> make_looks();

/// Sets the uniforms of particle.glsl for a batch.
void set_particle_uniforms(const Program& program, const ParticleBatch& batch, float radius_scale = 1);

}  // namespace dreampm::gl
