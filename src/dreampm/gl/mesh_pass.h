// How meshes look.
#pragma once
#include <span>

#include "dreampm/gl/mesh_store.h"
#include "dreampm/gl/sun_map.h"

namespace dreampm::gl {

class MeshPass {
 public:
  /// Opaque meshes, or the others, over what lies behind.
  void draw(std::span<const MeshOnDevice> meshes, const SunMap& sun, bool opaque);

 private:
  Program program_{"mesh.vert", "mesh.frag"};
};

}  // namespace dreampm::gl
