#include "dreampm/solver/projection/particles.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "dreampm/physics/projection/trilinear.h"
#include "dreampm/solver/projection/block_window.h"
#include "dreampm/state/mechanics.h"

namespace dreampm {
namespace {

/// Cells of a block's window beyond those that its particles reach where they are: half of a step
/// of two cells, and one.
constexpr int reach_ahead = 2;

/// Cells along each axis that a particle goes in a step at most: two sorts take it two blocks on.
/// It would go further only where the pressure found no solution, as in a vessel with too much
/// water.
constexpr double most_way = 7;

/// Cells beyond its block that a particle may be when it is sorted, twice.
constexpr double reach_of_sorts = 2 * block_width - 0.01;

/// Particles are kept so far within walls [cells].
constexpr double wall_gap = 1e-3;

/// The state of the particles of one set, as pointers.
template <class R>
struct Columns {
  R *u[3], *own[3], *gradient[9];
  explicit Columns(ParticleSet<R>& set) {
    for (std::size_t a = 0; a < 3; ++a) u[a] = set.u[a].data(), own[a] = set.own[a].data();
    for (std::size_t c = 0; c < 9; ++c) gradient[c] = set.gradient[c].data();
  }
};

template <class R>
void give_block(const World<R>& world, const ParticleSet<R>& set, std::size_t b, MacGrid<R>& grid) {
  if (set.block_start[b] == set.block_start[b + 1]) return;
  const Window<0> window(grid.cells, world.particle_blocks[b]);
  const R dx = static_cast<R>(world.dx), volume = static_cast<R>(set.rest_volume / (world.dx * world.dx * world.dx));
  for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
    const StaggeredPlace<R> place(Four<R>{set.u[0][p], set.u[1][p], set.u[2][p], 0} + R(0.5));
#pragma GCC unroll 3
    for (std::size_t a = 0; a < 3; ++a) {
      const TrilinearCell<R> cell = place.faces(static_cast<int>(a));
      Four<R> motion;
      motion_along(set, p, a, dx, motion);
      Four<R> given[4];
      given_to_faces(cell, motion, given);
      for (int n = 0; n < 4; ++n) {
        FaceSum<R>* const to =
            grid.sums[a].data() + window.place(cell.first[0] + (n >> 1), cell.first[1] + (n & 1), cell.first[2]);
        Four<R> sum;
        load<R>(to, sum);
        store<R>(sum + given[n], to);
      }
    }
    const TrilinearCell<R> cell = place.centers();
    const Corners<R> shares = shares_of_centers(cell);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        R* const to = grid.density.data() + window.place(cell.first[0] + i, cell.first[1] + j, cell.first[2]);
        const Four<R>& side = i ? shares.high : shares.low;
        to[0] += side[2 * j] * volume, to[1] += side[2 * j + 1] * volume;
      }
    grid.held[window.place(place.cell(0), place.cell(1), place.cell(2))] = 1;
  }
}

/// Two numbers that follow one another in each of two rows.
template <class R>
DM_FN void two_by_two(const R* first, const R* second, Four<R>& to) {
  using Two [[gnu::vector_size(2 * sizeof(R))]] = R;
  Two a, b;
  std::memcpy(&a, first, sizeof a), std::memcpy(&b, second, sizeof b);
  to = __builtin_shufflevector(a, b, 0, 1, 2, 3);
}

/// The square of a velocity, whose fourth number is 0; a huge one, or none at all, where any of it
/// is unknown.
template <class R>
DM_FN R square(const Four<R>& v) {
  const Four<R> s = v * v;
  return (s[0] + s[1]) + s[2];
}
template <class R>
DM_FN bool all_known(R square) {
  return square < R(1e20);
}

/// Velocities of a grid around a block of particles. Places and velocities are x, y, z, 0.
template <class R>
class Sampler {
 public:
  using Around = Window<reach_ahead>;
  Sampler(const CellRows& cells, const Around& window) : cells_(cells), window_(window) {}

  DM_FN void value(const std::array<LargeVector<R>, 3>& field, const Four<R>& x, Four<R>& v) const {
    if (holds(x)) {
      const StaggeredPlace<R> place(x);
      Four<R> parts[3];
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const TrilinearCell<R> cell = place.faces(a);
        trilinear_parts(cell, near(field[static_cast<std::size_t>(a)], cell), parts[a]);
      }
      const Four<R> none{};
      const Four<R> first = __builtin_shufflevector(parts[0], parts[1], 0, 4, 1, 5) +
                            __builtin_shufflevector(parts[0], parts[1], 2, 6, 3, 7),
                    last = __builtin_shufflevector(parts[2], none, 0, 4, 1, 5) +
                           __builtin_shufflevector(parts[2], none, 2, 6, 3, 7);
      v = __builtin_shufflevector(first, last, 0, 1, 4, 5) + __builtin_shufflevector(first, last, 2, 3, 6, 7);
      // A column whose own tile is not there may have one that the place is in.
      if (all_known(square<R>(v))) return;
    }
    value_anywhere(field, x, v);
  }
  /// Of each component the value and its slopes [1/cell], at a place of one of the block's
  /// particles.
  DM_FN void slope(const std::array<LargeVector<R>, 3>& field, const Four<R>& x, Four<R> (&found)[3]) const {
    const StaggeredPlace<R> place(x);
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      const LargeVector<R>& samples = field[static_cast<std::size_t>(a)];
      const TrilinearCell<R> cell = place.faces(a);
      trilinear_slope(cell, near(samples, cell), found[a]);
      if (!is_known(found[a][0])) trilinear_slope(cell, look_up(samples, cell), found[a]);
    }
  }

 private:
  static DM_FN bool holds(const Four<R>& x) {
    constexpr R begin = R(0.5), end = R(Around::width) - R(1);
    const auto within = (x >= begin) & (x < end);
    return (within[0] & within[1] & within[2]) != 0;
  }
  __attribute__((noinline)) void value_anywhere(const std::array<LargeVector<R>, 3>& field, const Four<R>& x,
                                                Four<R>& v) const {
    v = Four<R>{};
    for (int a = 0; a < 3; ++a) {
      const TrilinearCell<R> cell = anywhere(x, a);
      v[a] = trilinear_value(cell, look_up(field[static_cast<std::size_t>(a)], cell));
    }
  }
  DM_FN Corners<R> near(const LargeVector<R>& field, const TrilinearCell<R>& cell) const {
    const auto row = [&](int i, int j) {
      return field.data() + window_.place(cell.first[0] + i, cell.first[1] + j, cell.first[2]);
    };
    Corners<R> found;
    two_by_two(row(0, 0), row(0, 1), found.low), two_by_two(row(1, 0), row(1, 1), found.high);
    return found;
  }
  static TrilinearCell<R> anywhere(const Four<R>& x, int axis) {
    TrilinearCell<R> cell;
    for (int a = 0; a < 3; ++a) {
      const R at = a == axis ? x[a] : x[a] - R(0.5), whole = std::floor(at);
      cell.first[a] = static_cast<int>(whole), cell.way[a] = at - whole;
    }
    return cell;
  }
  Corners<R> look_up(const LargeVector<R>& field, const TrilinearCell<R>& cell) const {
    Corners<R> found;
    for (int n = 0; n < 8; ++n)
      (n < 4 ? found.low : found.high)[n & 3] = field[cells_.place_of(
          window_.first() + Vec3i{cell.first[0] + (n >> 2), cell.first[1] + (n >> 1 & 1), cell.first[2] + (n & 1)})];
    return found;
  }
  const CellRows& cells_;
  const Around& window_;
};

/// A particle of a set that comes to a surface goes on along it: the velocity that it has into it,
/// and the slopes of that, end. Else what rests in cells that hold too little for the pressure
/// falls on and on. Between two surfaces it becomes as slow as it went. Returns the energy that is
/// lost [J].
template <class R>
double stop_at(const typename CutCells<R>::Rescue::Surface& surface, const ParticleSet<R>& set, double dx,
               const Columns<R>& columns, std::size_t p) {
  const Vec3d& normal = surface.normal;
  Vec3d v;
  Mat3d slopes;
  for (int a = 0; a < 3; ++a) {
    const auto row = static_cast<std::size_t>(a);
    v[a] = static_cast<double>(columns.own[row][p]);
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
    columns.own[row][p] = static_cast<R>(v[a]);
    for (int b = 0; b < 3; ++b)
      columns.gradient[3 * row + static_cast<std::size_t>(b)][p] = static_cast<R>(slopes(a, b));
  }
  return before - kinetic_energy(set, dx, v, slopes);
}

struct BlockMove {
  double fastest2 = 0, kinetic = 0;
  bool finite = true, far = false;
};

template <class R>
BlockMove take_block(const World<R>& world, const ParticleSet<R>& set, const Columns<R>& columns, std::size_t b,
                     const MacGrid<R>& grid, const CutCells<R>& cut, double dt, const Vec3d& kick) {
  BlockMove found;
  const typename CutCells<R>::Rescue put_out(world, cut, world.particle_blocks[b], dt);
  const typename Sampler<R>::Around window(grid.cells, world.particle_blocks[b]);
  const Sampler<R> sampler(grid.cells, window);
  const R per_cell = static_cast<R>(1 / world.dx), way = static_cast<R>(dt / world.dx);
  Four<R> least{}, most{};
  for (int a = 0; a < 3; ++a) {
    least[a] = static_cast<R>(grid.low[a] - window.first()[a]) + static_cast<R>(wall_gap);
    most[a] = static_cast<R>(grid.high[a] - window.first()[a]) - static_cast<R>(wall_gap);
  }
  const auto hold = [&](Four<R>& x) {
    x = x < least ? least : x;
    x = x > most ? most : x;
  };
  constexpr R offset = R(0.5 + reach_ahead);
  const Four<R> furthest = Four<R>{} + R(most_way);
  // Some particles side by side: each waits for what it reads.
  constexpr std::size_t batch = 16;
  Four<R> start[batch], first[batch], second[batch];
  // Squares of velocities, and of what these change by in a cell along x, y, z.
  Four<R> squares{};
  double affine = 0;  // of those that keep their own [m^2/s^2]
  R fastest2 = 0;
  const std::size_t last = set.block_start[b + 1];
  for (std::size_t begin = set.block_start[b]; begin < last; begin += batch) {
    const std::size_t count = std::min(batch, last - begin);
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t p = begin + n;
      start[n] = Four<R>{columns.u[0][p], columns.u[1][p], columns.u[2][p], 0} + offset;
      Four<R> taken[3];
      sampler.slope(grid.velocity, start[n], taken);
      Four<R> v{taken[0][0], taken[1][0], taken[2][0], 0};
      R speed2 = square<R>(v);
      if (all_known(speed2)) {
#pragma GCC unroll 3
        for (std::size_t a = 0; a < 3; ++a) {
          const Four<R> slope = taken[a] * per_cell;
          columns.own[a][p] = taken[a][0];
          columns.gradient[3 * a][p] = slope[1];
          columns.gradient[3 * a + 1][p] = slope[2];
          columns.gradient[3 * a + 2][p] = slope[3];
          squares += taken[a] * taken[a];
        }
      } else {
        for (int a = 0; a < 3; ++a) v[a] = columns.own[a][p] += static_cast<R>(kick[a]);
        speed2 = square<R>(v);
        squares[0] += speed2;
        for (const R* const slope : columns.gradient) affine += static_cast<double>(slope[p] * slope[p]);
      }
      first[n] = v;
      // What is no number is not less than what was there.
      fastest2 = speed2 < fastest2 ? fastest2 : speed2;
    }
    const auto slope_at = [&](const Four<R>& from, Four<R>& slope, R part) {
      Four<R> at = from + slope * part, w;
      hold(at);
      sampler.value(grid.moving, at, w);
      if (all_known(square<R>(w))) slope = w;
    };
    for (std::size_t n = 0; n < count; ++n) {
      second[n] = first[n];
      slope_at(start[n], second[n], R(0.5) * way);
    }
    for (std::size_t n = 0; n < count; ++n) {
      Four<R> third = second[n];
      slope_at(start[n], third, R(0.75) * way);
      Four<R> gone = (first[n] * R(2) + second[n] * R(3) + third * R(4)) * (way / R(9));
      gone = gone < -furthest ? -furthest : gone;
      gone = gone > furthest ? furthest : gone;
      Four<R> end = start[n] + gone;
      hold(end);
      if (put_out.is_needed()) {
        Vec3<R> x{end[0], end[1], end[2]};
        const auto surface = put_out(window.first(), {start[n][0], start[n][1], start[n][2]}, x);
        if (surface.normal != Vec3d{}) found.kinetic -= stop_at<R>(surface, set, world.dx, columns, begin + n);
        end = Four<R>{x.x, x.y, x.z, 0};
        hold(end);
      }
      end -= offset;
      // Sorts take none further.
      end = end < R(-reach_of_sorts) ? Four<R>{} - R(reach_of_sorts) : end;
      end = end > R(block_width + reach_of_sorts) ? Four<R>{} + R(block_width + reach_of_sorts) : end;
      const auto near = (end > R(-block_width)) & (end < R(2 * block_width));
      found.far = found.far || (near[0] & near[1] & near[2]) == 0;
      for (int a = 0; a < 3; ++a) columns.u[a][begin + n] = end[a];
    }
  }
  found.fastest2 = static_cast<double>(fastest2);
  found.finite = std::isfinite(squares[0]);
  affine += (static_cast<double>(squares[1]) + static_cast<double>(squares[2]) + static_cast<double>(squares[3])) /
            (world.dx * world.dx);
  found.kinetic += 0.5 * (set.mass * static_cast<double>(squares[0]) + affine_inertia(set, world.dx) * affine);
  return found;
}

template <class R>
R speed2_of(const ParticleSet<R>& set, std::size_t p) {
  const Vec3<R> v{set.own[0][p], set.own[1][p], set.own[2][p]};
  return dot(v, v);
}

/// m/s, that all but 0.1 % of the particles keep.
template <class R>
double usual_speed(const World<R>& world) {
  std::vector<float> sampled;
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
void particles_to_grid(const World<R>& world, MacGrid<R>& grid) {
  for_blocks_by_color(world, [&](std::size_t b) {
    for (const ParticleSet<R>& set : world.sets)
      if (set.size() > 0 && is_projected(set)) give_block(world, set, b, grid);
  });
  if (!grid.cells.wraps()) return;
  for (auto& f : grid.sums) grid.cells.fold(f.data());
  grid.cells.fold(grid.density.data());
}

template <class R>
MoveStats grid_to_particles(World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut, double dt,
                            const Vec3d& kick) {
  std::vector<BlockMove> found(world.particle_blocks.size());
  MoveStats stats;
  for (ParticleSet<R>& set : world.sets) {
    if (set.size() == 0 || !is_projected(set)) continue;
    const Columns<R> columns(set);
    parallel_for(found.size(), 4,
                 [&](std::size_t b) { found[b] = take_block(world, set, columns, b, grid, cut, dt, kick); });
    for (const BlockMove& b : found) {
      stats.fastest = std::max(stats.fastest, b.fastest2);
      stats.kinetic += b.kinetic;
      stats.finite = stats.finite && b.finite, stats.far = stats.far || b.far;
    }
  }
  stats.fastest = std::sqrt(stats.fastest);
  stats.usual = usual_speed(world);
  return stats;
}

template <class R>
FlowSpeeds flow_speeds(const World<R>& world) {
  FlowSpeeds flow;
  double fastest2 = 0;
  for (const ParticleSet<R>& set : world.sets) {
    // What is no number is not less than what was there.
    const auto keep = [](double& most, double other) { most = other < most ? most : other; };
    keep(fastest2,
         parallel_reduce(set.size(), 0.0, [&](double& most, std::size_t p) { keep(most, speed2_of(set, p)); }, keep));
  }
  flow.fastest = std::sqrt(fastest2);
  flow.usual = usual_speed(world);
  return flow;
}

#define DM_INSTANTIATE(R)                                        \
  template void particles_to_grid(const World<R>&, MacGrid<R>&); \
  template FlowSpeeds flow_speeds(const World<R>&);              \
  template MoveStats grid_to_particles(World<R>&, const MacGrid<R>&, const CutCells<R>&, double, const Vec3d&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
