// Meshes on their way to the driver, and how they are drawn.
#pragma once
#include <span>
#include <vector>

#include "dreampm/gl/objects.h"
#include "dreampm/gl/picture.h"

namespace dreampm::gl {

struct MeshOnDevice {
  const MeshBatch* batch;
  const VertexArray* vertices;
  int count;  ///< of indices
  Mat4f pose;
};

class MeshStore {
 public:
  /// Copies what has changed; the result is valid until the next call. Throws InputError where
  /// normals do not fit or an index is out of range.
  std::span<const MeshOnDevice> upload(std::span<const MeshBatch> meshes);

 private:
  struct Slot {
    Buffer position, normal, index;
    VertexArray vertices;
    const void *vertex_data = nullptr, *triangle_data = nullptr, *normal_data = nullptr;
    std::size_t vertex_count = 0, triangle_count = 0, normal_count = 0;
    std::uint64_t revision = 0;
  };
  bool changed(Slot& slot, const MeshBatch& mesh);

  std::vector<Slot> slots_;
  std::vector<MeshOnDevice> meshes_;
};

}  // namespace dreampm::gl
