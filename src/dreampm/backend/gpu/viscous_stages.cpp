#include "dreampm/backend/gpu/viscous_stages.h"

#include "dreampm/backend/block_visit.h"

namespace dreampm::gpu {

double ViscousStages::operator()(World<float>& world, Memory& memory, GridVisit& visit, ParticlePasses& passes,
                                 GridFields<float>& next, double dt, GridStats& found) {
  sums_.begin(world.colliders.size(), found);
  const std::size_t blocks = world.grid.blocks.size();
  for (std::size_t f = 0; f < 2; ++f) {
    const std::size_t nodes = world.grid.field(f).size();
    old_[f].resize(nodes), change_[f].resize(nodes);
  }
  driven_.resize(blocks);
  for (int number = 1; number <= world.viscous_stages; ++number) {
    passes.find_viscous_forces(world, dt, next);
    const RklFactors factors(world.viscous_stages, number);
    VisitInput in = visit.input(world, memory, dt, factors.gain);
    in.damped = nullptr;  // damping acted before the stages
    StageInput stage{static_cast<float>(factors.kept),
                     static_cast<float>(factors.gain),
                     factors.part,
                     static_cast<Vec3<float>>(world.gravity_over(dt) * dt),
                     number == 1,
                     {},
                     in.step.skin ? visit.dragged() : nullptr,
                     driven_.data()};
    for (std::size_t f = 0; f < 2; ++f)
      stage.field[f] = {memory.momenta[f].data(), memory.nodes[of_field(stress_nodes, f)].data(), old_[f].data(),
                        change_[f].data()};
    launch(*device_, BeginStage{in, stage}, blocks);
    launch(*device_, DragSolids{visit.shared_nodes(in), stage}, visit.shared_count());
    GridStats stats;
    stats.colliders.resize(world.colliders.size());
    visit.contact(in, &stage, world, dt);
    launch(*device_, EndStage{in, stage}, blocks);
    const double work = visit.add_results(in, &stage, stats);
    sums_.add(std::move(stats), work, factors.kept);
  }
  found.max_speed = passes.fastest_particle(world);
  found.fields.work = visit.field_work(visit.input(world, memory, dt, 0));
  return sums_.end(found);
}

}  // namespace dreampm::gpu
