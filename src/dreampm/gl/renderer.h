// Draws pictures with OpenGL 3.3 core.
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "dreampm/gl/camera.h"
#include "dreampm/gl/framebuffer.h"
#include "dreampm/gl/picture.h"

namespace dreampm::gl {

/// Needs a current context of OpenGL 3.3 core from its birth to its end. Keeps buffers and textures
/// between frames: a frame of the same size and with no more particles takes no new memory.
class Renderer {
 public:
  /// Throws RunError where a shader does not compile, naming shader and line.
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// What ParticleBatch::look may be: "points", "spheres", "grains", "skin",
  /// "water".
  std::vector<std::string_view> look_names() const;

  /// Draws over all of the framebuffer. Particles that are not numbers are left out. Throws
  /// InputError for a look that is not there and for arrays that do not fit together, RunError if
  /// OpenGL fails. Leaves framebuffer 0 and no program bound, and blending, depth and scissor tests
  /// off.
  void draw(const Picture& picture, const Camera& camera, const Framebuffer& framebuffer);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dreampm::gl
