#include "dreampm/backend/reductions.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// A sum that is rounded once and not in every addition (Neumaier 1974): equal terms would be
/// rounded to one side.
class Sum {
 public:
  void add(double x) {
    const double next = sum_ + x;
    rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
    sum_ = next;
  }
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0, rest_ = 0;
};

class VectorSum {
 public:
  void add(const Vec3d& v) { x_.add(v.x), y_.add(v.y), z_.add(v.z); }
  Vec3d value() const { return {x_.value(), y_.value(), z_.value()}; }

 private:
  Sum x_, y_, z_;
};

}  // namespace

template <class R>
Balance balance(const World<R>& world, const Motion<R>& motion) {
  Balance sum;
  Sum mass, kinetic, elastic, potential, volume;
  VectorSum momentum, angular;
  const Vec3d gravity = world.gravity_at(world.time);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const auto& set = world.sets[s];
    const auto& m = motion.sets[s];
    ParticleSetView(world, s).for_each([&](std::size_t p, const Vec3d& x) {
      const Vec3d v = static_cast<Vec3d>(m.velocity[p]);
      const Mat3d c = static_cast<Mat3d>(m.gradient[p]);
      const double j = static_cast<double>(m.volume_ratio[p]);
      mass.add(set.mass);
      momentum.add(v * set.mass);
      angular.add(angular_momentum(set, world.dx, x, v, c));
      kinetic.add(kinetic_energy(set, world.dx, v, c));
      elastic.add(static_cast<double>(m.energy[p]) * set.rest_volume);
      potential.add(-set.mass * dot(gravity, x));
      volume.add(set.rest_volume * j);
      sum.j_min = std::min(sum.j_min, j);
      sum.j_max = std::max(sum.j_max, j);
    });
  }
  sum.mass = mass.value(), sum.volume = volume.value();
  sum.momentum = momentum.value(), sum.angular = angular.value();
  sum.kinetic = kinetic.value(), sum.elastic = elastic.value(), sum.gravity = potential.value();
  return sum;
}

template <class R>
double stress_power(const World<R>& world, const Motion<R>& motion) {
  double power = 0;
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const auto& set = world.sets[s];
    const auto& gradient = motion.sets[s].gradient;
    Materials::with(set.material, [&]<class M>() {
      const auto law = M::template Law<R>::from(set.values);
      const auto of_particle = [&](double& sum, std::size_t p) {
        const Sym3<R> tau = law.respond(state_of<M>(set, p)).tau;
        const Mat3<R>& g = gradient[p];
        sum +=
            static_cast<double>(tau.xx * g(0, 0) + tau.yy * g(1, 1) + tau.zz * g(2, 2) + tau.xy * (g(0, 1) + g(1, 0)) +
                                tau.xz * (g(0, 2) + g(2, 0)) + tau.yz * (g(1, 2) + g(2, 1)));
      };
      power += parallel_reduce(set.size(), 0.0, of_particle) * set.rest_volume;
    });
  }
  return power;
}

template <class R>
ImpulseSum grid_momentum(const World<R>& world, NodesHold hold) {
  const bool velocities = hold == NodesHold::velocities;
  const auto add_block = [&](ImpulseSum& sum, std::size_t b) {
    for (const auto* field : {&world.grid.nodes, &world.grid.solids}) {
      if (field->empty()) continue;
      for (int n = 0; n < block_nodes; ++n) {
        const Node<R>& node = (*field)[b * block_nodes + static_cast<std::size_t>(n)];
        if (!(node.m > R(0))) continue;
        const Vec3d p =
            static_cast<Vec3d>(Vec3<R>{node.x, node.y, node.z}) * (velocities ? static_cast<double>(node.m) : 1);
        sum.impulse += p;
        sum.angular += cross(world.node_position(world.grid.blocks[b] * block_width + node_offset(n)), p);
      }
    }
  };
  return parallel_reduce(world.grid.blocks.size(), ImpulseSum{}, add_block);
}

template Balance balance(const World<float>&, const Motion<float>&);
template Balance balance(const World<double>&, const Motion<double>&);
template double stress_power(const World<float>&, const Motion<float>&);
template double stress_power(const World<double>&, const Motion<double>&);
template ImpulseSum grid_momentum(const World<float>&, NodesHold);
template ImpulseSum grid_momentum(const World<double>&, NodesHold);

}  // namespace dreampm
