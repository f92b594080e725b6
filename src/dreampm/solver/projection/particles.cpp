#include "dreampm/solver/projection/particles.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dreampm/physics/projection/trilinear.h"
#include "dreampm/solver/projection/block_window.h"
#include "dreampm/state/mechanics.h"

namespace dreampm {
namespace {

/// Particles are kept so far within walls [cells].
constexpr double wall_gap = 1e-3;

/// The particles of one set in one block. T: R or const R, as the set is.
template <class T, class Set>
BlockColumns<T> columns_of(Set& set, std::size_t b) {
  BlockColumns<T> columns{{}, {}, {}, set.block_start[b], set.block_start[b + 1]};
  for (std::size_t a = 0; a < 3; ++a)
    columns.u[a] = set.u[a].data(), columns.own_velocity[a] = set.own_velocity[a].data();
  for (std::size_t c = 0; c < 9; ++c) columns.gradient[c] = set.gradient[c].data();
  return columns;
}

template <class R>
void give_block(const World<R>& world, const ParticleSet<R>& set, std::size_t b, const ProjectionKernels<R>& kernels,
                MacGrid<R>& grid) {
  if (set.block_start[b] == set.block_start[b + 1]) return;
  const Window<0> window(grid.cells, world.particle_blocks[b]);
  kernels.give({columns_of<const R>(set, b),
                static_cast<R>(world.dx),
                static_cast<R>(set.rest_volume / (world.dx * world.dx * world.dx)),
                window.columns(),
                {grid.sums[0].data(), grid.sums[1].data(), grid.sums[2].data()},
                grid.density.data(),
                grid.held.data()});
}

/// A particle of a set that comes to a surface goes on along it: the velocity that it has into it,
/// and the slopes of that, end. Else what rests in cells that hold too little for the pressure
/// falls on and on. Between two surfaces it becomes as slow as it went. Returns the energy that is
/// lost [J].
template <class R>
double stop_at(const typename CutCells<R>::Collisions::Surface& surface, const ParticleSet<R>& set, double dx,
               const BlockColumns<R>& columns, std::size_t p) {
  const Vec3d& normal = surface.normal;
  Vec3d v;
  Mat3d slopes;
  for (int a = 0; a < 3; ++a) {
    const auto row = static_cast<std::size_t>(a);
    v[a] = static_cast<double>(columns.own_velocity[row][p]);
    for (int b = 0; b < 3; ++b)
      slopes(a, b) = static_cast<double>(columns.gradient[3 * row + static_cast<std::size_t>(b)][p]);
  }
  const double into = dot(v - surface.velocity, normal), fast = length(v - surface.velocity);
  if (!(into < 0)) return 0;
  const double before = kinetic_energy(set, dx, v, slopes);
  const Vec3d into_slope = transpose(slopes) * normal;
  v -= normal * into, slopes = slopes - outer(normal, into_slope);
  const Vec3d along = v - surface.velocity;
  const double too_fast = length(along) - surface.part * fast;
  if (too_fast > 0) {
    const double kept = 1 - too_fast / length(along);
    v = surface.velocity + along * kept, slopes = slopes * kept;
  }
  for (int a = 0; a < 3; ++a) {
    const auto row = static_cast<std::size_t>(a);
    columns.own_velocity[row][p] = static_cast<R>(v[a]);
    for (int b = 0; b < 3; ++b)
      columns.gradient[3 * row + static_cast<std::size_t>(b)][p] = static_cast<R>(slopes(a, b));
  }
  return before - kinetic_energy(set, dx, v, slopes);
}

/// Velocities of a grid anywhere, one place after the other, and colliders near a block.
template <class R>
class Anywhere {
 public:
  Anywhere(const MacGrid<R>& grid, const CutCells<R>& cut, const World<R>& world, ParticleSet<R>& set, std::size_t b,
           const Vec3i& first, double dt)
      : grid_(grid),
        collisions_(world, cut, world.particle_blocks[b], dt),
        set_(set),
        columns_(columns_of<R>(set, b)),
        first_(first),
        dx_(world.dx) {}
  Beyond<R> as_beyond() const {
    return {this,
            [](const void* context, const R(&x)[3], R(&v)[3]) { static_cast<const Anywhere*>(context)->moving(x, v); },
            [](const void* context, const R(&x)[3], R(&found)[3][4]) {
              static_cast<const Anywhere*>(context)->slope(x, found);
            },
            collisions_.is_needed() ? &put_out : nullptr};
  }

 private:
  void moving(const R (&x)[3], R (&v)[3]) const {
    for (std::size_t a = 0; a < 3; ++a) {
      Vec3<R> way;
      Samples<R> samples;
      look_up(grid_.moving[a], x, a, way, samples);
      v[a] = trilinear_value(way, samples);
    }
  }
  void slope(const R (&x)[3], R (&found)[3][4]) const {
    for (std::size_t a = 0; a < 3; ++a) {
      Vec3<R> way, slope;
      Samples<R> samples;
      look_up(grid_.velocity[a], x, a, way, samples);
      trilinear_slope(way, samples, found[a][0], slope);
      for (int t = 0; t < 3; ++t) found[a][t + 1] = slope[t];
    }
  }
  static double put_out(const void* context, std::size_t particle, const R (&start)[3], R (&x)[3]) {
    const auto& self = *static_cast<const Anywhere*>(context);
    Vec3<R> at{x[0], x[1], x[2]};
    const auto surface = self.collisions_(self.first_, {start[0], start[1], start[2]}, at);
    if (surface.normal == Vec3d{}) return 0;
    for (int a = 0; a < 3; ++a) x[a] = at[a];
    return stop_at<R>(surface, self.set_, self.dx_, self.columns_, particle);
  }
  void look_up(const LargeVector<R>& field, const R (&x)[3], std::size_t axis, Vec3<R>& way,
               Samples<R>& samples) const {
    Vec3i cell;
    for (int a = 0; a < 3; ++a) {
      const R at = a == static_cast<int>(axis) ? x[a] : x[a] - R(0.5), whole = std::floor(at);
      cell[a] = static_cast<std::int32_t>(whole), way[a] = at - whole;
    }
    for (int n = 0; n < 8; ++n)
      samples.at[n >> 2][n >> 1 & 1][n & 1] =
          field[grid_.cells.place_of(first_ + cell + Vec3i{n >> 2, n >> 1 & 1, n & 1})];
  }

  const MacGrid<R>& grid_;
  const typename CutCells<R>::Collisions collisions_;
  const ParticleSet<R>& set_;
  const BlockColumns<R> columns_;
  const Vec3i first_;
  const double dx_;
};

template <class R>
BlockMove take_block(const World<R>& world, ParticleSet<R>& set, std::size_t b, const ProjectionKernels<R>& kernels,
                     const MacGrid<R>& grid, const CutCells<R>& cut, double dt, const Vec3d& kick) {
  const Window<reach_ahead> window(grid.cells, world.particle_blocks[b]);
  const Anywhere<R> anywhere(grid, cut, world, set, b, window.first(), dt);
  BlockTaking<R> taking{columns_of<R>(set, b),         {}, {}, window.columns(),           static_cast<R>(1 / world.dx),
                        static_cast<R>(dt / world.dx), {}, {}, static_cast<Vec3<R>>(kick), anywhere.as_beyond()};
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    taking.velocity[a] = grid.velocity[axis].data(), taking.moving[a] = grid.moving[axis].data();
    taking.least[a] = static_cast<R>(grid.low[a] - window.first()[a]) + static_cast<R>(wall_gap);
    taking.most[a] = static_cast<R>(grid.high[a] - window.first()[a]) - static_cast<R>(wall_gap);
  }
  BlockMove found;
  kernels.take(taking, found);
  return found;
}

template <class R>
R speed2_of(const ParticleSet<R>& set, std::size_t p) {
  const Vec3<R> v{set.own_velocity[0][p], set.own_velocity[1][p], set.own_velocity[2][p]};
  return dot(v, v);
}

/// m/s, that all but 0.1 % of the particles keep.
template <class R>
double usual_speed(const World<R>& world, std::vector<float>& sampled) {
  sampled.clear();
  constexpr std::size_t stride = 16;  // of the particles whose speed stands for all
  for (const ParticleSet<R>& set : world.sets)
    for (std::size_t p = 0; p < set.size(); p += stride) sampled.push_back(static_cast<float>(speed2_of(set, p)));
  if (sampled.empty()) return 0;
  const auto usual = sampled.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(sampled.size() - 1) * 0.999);
  std::nth_element(sampled.begin(), usual, sampled.end());
  return std::sqrt(static_cast<double>(*usual));
}

}  // namespace

template <class R>
void particles_to_grid(const World<R>& world, const ProjectionKernels<R>& kernels, MacGrid<R>& grid) {
  for_blocks_by_color(world, [&](std::size_t b) {
    for (const ParticleSet<R>& set : world.sets)
      if (set.size() > 0 && is_projected(set)) give_block(world, set, b, kernels, grid);
  });
  if (!grid.cells.wraps()) return;
  for (auto& f : grid.sums) grid.cells.fold(f.data());
  grid.cells.fold(grid.density.data());
}

template <class R>
MoveStats grid_to_particles(World<R>& world, const ProjectionKernels<R>& kernels, const MacGrid<R>& grid,
                            const CutCells<R>& cut, double dt, const Vec3d& kick, std::vector<float>& scratch) {
  MoveStats stats;
  for (ParticleSet<R>& set : world.sets) {
    if (set.size() == 0 || !is_projected(set)) continue;
    const BlockMove all = parallel_reduce(
        world.particle_blocks.size(), BlockMove{},
        [&](BlockMove& sum, std::size_t b) {
          if (set.block_start[b] < set.block_start[b + 1])
            sum.add(take_block(world, set, b, kernels, grid, cut, dt, kick));
        },
        [](BlockMove& sum, const BlockMove& from) { sum.add(from); });
    stats.fastest = std::max(stats.fastest, all.fastest2);
    stats.kinetic += 0.5 * (set.mass * all.speed2 + affine_inertia(set, world.dx) * all.slope2) - all.lost;
    stats.finite = stats.finite && all.finite, stats.far = stats.far || all.far;
  }
  stats.fastest = std::sqrt(stats.fastest);
  stats.usual = usual_speed(world, scratch);
  return stats;
}

template <class R>
FlowSpeeds flow_speeds(const World<R>& world) {
  FlowSpeeds flow;
  double fastest2 = 0;
  for (const ParticleSet<R>& set : world.sets) {
    // A NaN compares as not less, and is not kept.
    const auto keep = [](double& most, double other) { most = other < most ? most : other; };
    keep(fastest2,
         parallel_reduce(set.size(), 0.0, [&](double& most, std::size_t p) { keep(most, speed2_of(set, p)); }, keep));
  }
  flow.fastest = std::sqrt(fastest2);
  std::vector<float> scratch;
  flow.usual = usual_speed(world, scratch);
  return flow;
}

#define DM_INSTANTIATE(R)                                                                                             \
  template void particles_to_grid(const World<R>&, const ProjectionKernels<R>&, MacGrid<R>&);                         \
  template FlowSpeeds flow_speeds(const World<R>&);                                                                   \
  template MoveStats grid_to_particles(World<R>&, const ProjectionKernels<R>&, const MacGrid<R>&, const CutCells<R>&, \
                                       double, const Vec3d&, std::vector<float>&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
