#include "dreampm/solver/projection/viscous_bodies.h"

namespace dreampm {

template <class R>
void ViscousBodies<R>::lock(std::vector<Six>& vectors) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (std::size_t n = 0; n < 6; ++n)
      if (bodies_[b].locked[n]) vectors[b][n] = 0;
}

template <class R>
void ViscousBodies<R>::gather(const Faces& f, std::vector<Six>& bodies) const {
  bodies.assign(bodies_.size(), {});
  for (const Face& face : faces_)
    for (std::size_t n = 0; n < 6; ++n)
      bodies[face.body][n] += face.column[n] * static_cast<double>(f[face.axis][face.place]);
  lock(bodies);
}

template <class R>
void ViscousBodies<R>::scatter(const std::vector<Six>& bodies, Faces& u) const {
  for (const Face& face : faces_) u[face.axis][face.place] = static_cast<R>(dot(face.column, bodies[face.body]));
}

template <class R>
void ViscousBodies<R>::weigh(const std::vector<Six>& velocities, std::vector<Six>& out) const {
  out.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) out[b] = bodies_[b].mass * velocities[b];
  lock(out);
}

template <class R>
void ViscousBodies<R>::precondition(const std::vector<Six>& residual, std::vector<Six>& out) const {
  out.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) out[b] = bodies_[b].inverse * residual[b];
  lock(out);
}

template <class R>
void ViscousBodies<R>::move(World<R>& world, const std::vector<Six>& change) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) add(world.colliders[bodies_[b].collider].twist, change[b]);
}

template class ViscousBodies<float>;
template class ViscousBodies<double>;

}  // namespace dreampm
