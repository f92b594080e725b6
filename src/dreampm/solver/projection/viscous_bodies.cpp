#include "dreampm/solver/projection/viscous_bodies.h"

#include <algorithm>
#include <tuple>

namespace dreampm {

template <class R>
void ViscousBodies<R>::lock(std::vector<Six>& vectors) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (std::size_t n = 0; n < 6; ++n)
      if (bodies_[b].locked[n]) vectors[b][n] = 0;
}

template <class R>
void ViscousBodies<R>::add_cells(const BodyPressure<R>& pressed, const SurfaceStress<R>& surfaces) {
  cells_.clear();
  if (surfaces.any() && !bodies_.empty()) {
    for (const auto& cell : pressed.cells())
      if (surfaces.kappa(cell.place) > R(0)) cells_.push_back(cell);
    // One a body for each cell, of all of its faces.
    std::sort(cells_.begin(), cells_.end(), [](const auto& a, const auto& b) {
      return std::tie(a.place, a.body, a.column) < std::tie(b.place, b.body, b.column);
    });
    std::size_t kept = 0;
    for (std::size_t n = 0; n < cells_.size(); ++n)
      if (n > 0 && cells_[kept - 1].place == cells_[n].place && cells_[kept - 1].body == cells_[n].body)
        for (std::size_t m = 0; m < 6; ++m) cells_[kept - 1].column[m] += cells_[n].column[m];
      else
        cells_[kept++] = cells_[n];
    cells_.resize(kept);
    for (const auto& cell : cells_) {
      const auto kappa = static_cast<double>(surfaces.kappa(cell.place));
      for (std::size_t n = 0; n < 6; ++n)
        for (std::size_t m = 0; m < 6; ++m) bodies_[cell.body].inverse[n][m] += kappa * cell.column[n] * cell.column[m];
    }
  }
  for (Body& b : bodies_) {
    for (std::size_t n = 0; n < 6; ++n)
      if (b.locked[n])
        for (std::size_t m = 0; m < 6; ++m) b.inverse[n][m] = b.inverse[m][n] = n == m ? 1 : 0;
    b.inverse = inverse(b.inverse);
  }
}

template <class R>
void ViscousBodies<R>::gather(const Faces& f, const SurfaceStress<R>& surfaces, std::vector<Six>& bodies) const {
  bodies.assign(bodies_.size(), {});
  for (const Face& face : faces_)
    for (std::size_t n = 0; n < 6; ++n)
      bodies[face.body][n] += face.column[n] * static_cast<double>(f[face.axis][face.place]);
  for (const auto& cell : cells_)
    for (std::size_t n = 0; n < 6; ++n)
      bodies[cell.body][n] -= cell.column[n] * static_cast<double>(surfaces.pull()[cell.place]);
  lock(bodies);
}

template <class R>
void ViscousBodies<R>::scatter(const std::vector<Six>& bodies, Faces& u) const {
  for (const Face& face : faces_) u[face.axis][face.place] = static_cast<R>(dot(face.column, bodies[face.body]));
}

template <class R>
void ViscousBodies<R>::scatter_more(const std::vector<Six>& bodies, Faces& u, MacGrid<R>& grid) const {
  for (const Face& face : faces_) {
    R& at = u[face.axis][face.place];
    at += static_cast<R>(dot(face.column, bodies[face.body]));
    if (grid.open[face.axis][face.place] > R(0)) grid.free[face.axis][face.place] = at;
  }
}

template <class R>
void ViscousBodies<R>::add_flow(const std::vector<Six>& bodies, SurfaceStress<R>& surfaces) const {
  for (const auto& cell : cells_) surfaces.add_flow(cell.place, dot(cell.column, bodies[cell.body]));
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
