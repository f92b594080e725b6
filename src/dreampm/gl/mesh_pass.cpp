#include "dreampm/gl/mesh_pass.h"

#include <epoxy/gl.h>

namespace dreampm::gl {

void MeshPass::draw(std::span<const MeshOnDevice> meshes, const SunMap& sun, bool opaque) {
  program_.use();
  program_.texture("sun_depth", 0, sun.depth());
  program_.texture("sun_darkness", 1, sun.darkness());
  for (const MeshOnDevice& m : meshes) {
    if (m.count == 0 || (m.batch->opacity >= 1) != opaque) continue;
    program_.set("pose", m.pose);
    program_.set("color", m.batch->color * m.batch->color, m.batch->opacity);
    program_.set("flat_faces", m.batch->normals.empty() ? 1.0f : 0.0f);
    m.vertices->bind();
    if (!opaque) {
      // Only the front layer is blended: its depth first.
      glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
      glDrawElements(GL_TRIANGLES, m.count, GL_UNSIGNED_INT, nullptr);
      glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
      glDepthFunc(GL_LEQUAL);
      glEnable(GL_BLEND);
      glBlendEquation(GL_FUNC_ADD);
      glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    glDrawElements(GL_TRIANGLES, m.count, GL_UNSIGNED_INT, nullptr);
    if (!opaque) {
      glDisable(GL_BLEND);
      glDepthFunc(GL_LESS);
    }
  }
}

}  // namespace dreampm::gl
