// The physics of a step as device code: all materials through particle_step, the node formulas, gather and scatter.
// Compiled by tools/check_device; it runs nowhere.
#include "dreampm/physics/materials.h"
#include "dreampm/physics/node.h"
#include "dreampm/physics/particle.h"

#ifdef __clang__
#define DM_KERNEL __attribute__((global))
#else
#define DM_KERNEL __global__
#endif

namespace dreampm {

/// One particle, of one thread.
template <class M>
struct ParticleInput {
  typename M::template Law<float> law;
  SetStep<float> set;
  BlockWalls<float> walls;
  G2PResult<float> gathered;
};

template <class M>
DM_KERNEL void step_particle(const ParticleInput<M>* in, Vec3<float>* u, typename M::template State<float>* state,
                             P2GTerms<float>* out) {
  bool pushed;
  StressResponse<float> response;
  *out = particle_step<M, float>(in->law, in->set, in->walls, in->gathered, *u, *state, response, pushed);
}

template <class... M>
constexpr int instantiate(MaterialList<M...>) {
  int count = 0;
  ((count += &step_particle<M> != nullptr), ...);
  return count;
}
inline const int kernels = instantiate(OwnMaterials{});

}  // namespace dreampm
