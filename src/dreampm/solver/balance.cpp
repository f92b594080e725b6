#include "dreampm/solver/balance.h"

#include <algorithm>
#include <unordered_map>

namespace dreampm {

template <class R>
Balance balance(const World<R>& world, const Motion<R>& motion) {
  Balance sum;
  const Vec3d gravity = world.gravity_at(world.time);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const auto& set = world.sets[s];
    const auto& m = motion.sets[s];
    const double inertia = affine_inertia(set, world.dx);
    for (std::size_t b = 0; b < world.particle_blocks.size(); ++b)
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
        const Vec3d x = world.position(world.particle_blocks[b], Vec3<R>{set.u[0][p], set.u[1][p], set.u[2][p]});
        const Vec3d v = static_cast<Vec3d>(m.velocity[p]);
        const Mat3d c = static_cast<Mat3d>(m.gradient[p]);
        const double j = static_cast<double>(m.volume_ratio[p]);
        sum.mass += set.mass;
        sum.momentum += v * set.mass;
        sum.angular +=
            cross(x, v) * set.mass + Vec3d{c(2, 1) - c(1, 2), c(0, 2) - c(2, 0), c(1, 0) - c(0, 1)} * inertia;
        sum.kinetic += kinetic_energy(set, world.dx, v, c);
        sum.elastic += static_cast<double>(m.energy[p]) * set.rest_volume;
        sum.gravity -= set.mass * dot(gravity, x);
        sum.volume += set.rest_volume * j;
        sum.j_min = std::min(sum.j_min, j);
        sum.j_max = std::max(sum.j_max, j);
      }
  }
  return sum;
}

template <class R>
Motion<R> motion_at_birth(const World<R>& world, const std::vector<std::vector<Newborn>>& newborns) {
  Motion<R> motion;
  motion.sets.resize(world.sets.size());
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const auto& set = world.sets[s];
    auto& m = motion.sets[s];
    std::unordered_map<std::uint32_t, const Newborn*> by_id;
    for (const Newborn& n : newborns[s]) by_id.emplace(n.id, &n);
    for (const std::uint32_t id : set.id) {
      const Newborn& n = *by_id.at(id);
      m.velocity.push_back(static_cast<Vec3<R>>(n.velocity));
      m.gradient.push_back(static_cast<Mat3<R>>(n.gradient));
    }
    m.energy.assign(set.size(), R(0));
    m.volume_ratio.assign(set.size(), R(1));
  }
  return motion;
}

template Balance balance(const World<float>&, const Motion<float>&);
template Balance balance(const World<double>&, const Motion<double>&);
template Motion<float> motion_at_birth(const World<float>&, const std::vector<std::vector<Newborn>>&);
template Motion<double> motion_at_birth(const World<double>&, const std::vector<std::vector<Newborn>>&);

}  // namespace dreampm
