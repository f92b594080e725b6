#include "dreampm/run/particle_observer.h"

#include <utility>

#include "dreampm/io/numbered.h"
#include "dreampm/pictures/frames.h"

namespace dreampm {

template <class R>
void ParticleObserver<R>::on_frame() {
  engine_.download(MatterFields::all);
  const World<R>& world = std::as_const(engine_).world();
  const ParticleFrame frame = particle_frame(world, engine_.motion(), bodies_, content_.attributes, content_.shift);
  write_particles(folder_ / numbered("particles", world.frame, ".ply"), frame);
  for (const auto& use : uses_) use(frame);
}

template class ParticleObserver<float>;
template class ParticleObserver<double>;

}  // namespace dreampm
