// Particles on their way to the driver: one set of buffers a batch, kept between frames.
#pragma once
#include <span>
#include <vector>

#include "dreampm/gl/depth_order.h"
#include "dreampm/gl/look.h"

namespace dreampm::gl {

class ParticleStore {
 public:
  /// Copies all batches; the result is valid until the next call. Throws InputError where arrays of
  /// a batch differ in length or its numbers are out of range.
  std::span<BatchOnDevice> upload(std::span<const ParticleBatch> batches);
  /// Gives a batch of the last call its indices.
  void order(const Camera& camera, std::size_t batch);

 private:
  struct Slot {
    Buffer position, value, color, order;
    VertexArray vertices, thinned;
  };
  std::vector<Slot> slots_;
  std::vector<BatchOnDevice> batches_;
  DepthOrder order_;
};

}  // namespace dreampm::gl
