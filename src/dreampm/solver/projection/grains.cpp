#include "dreampm/solver/projection/grains.h"

#include <algorithm>
#include <cmath>

#include "dreampm/physics/projection/surface.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// The least mass of grains at a face that counts, over the mass of a cell of liquid.
constexpr double least_grains = 1e-6;

template <class R>
double diameter_of(const ParticleSet<R>& set) {
  const double given = set.values["grain_size"];
  return given > 0 ? given : GrainNumbers::diameter;
}

/// Returns the drag of the set with the finest grains.
template <class R>
double drag_of(const World<R>& world) {
  const ParticleSet<R>* const liquid = liquid_of(world);
  const double viscosity = liquid ? liquid->values["viscosity"] / liquid->values["density"] : 0;
  double drag = 0;
  for (const ParticleSet<R>& set : world.sets)
    if (is_grains(set)) drag = std::max(drag, grain_drag(diameter_of(set), viscosity));
  return drag;
}

}  // namespace

double grain_drag(double diameter, double viscosity) {
  return GrainNumbers::inertial_drag * std::sqrt(GrainNumbers::diameter / diameter) +
         18 * viscosity / (diameter * diameter);
}

template <class R>
void Grains<R>::to_grid(const World<R>& world, MacGrid<R>& grid) {
  any_ = std::any_of(world.sets.begin(), world.sets.end(),
                     [](const ParticleSet<R>& set) { return set.size() > 0 && is_grains(set); });
  grid.grain_volume.clear();
  for (auto& sums : grid.grain_sums) sums.clear();
  if (!any_) return;
  const std::size_t size = grid.cells.size();
  grid.grain_volume.assign(size, R(0));
  for (std::size_t a = 0; a < 3; ++a) {
    grid.grain_sums[a].assign(size, FaceSum<R>{});
    volume_[a].assign(size, R(0));
    for (Faces* f : {&own_, &flux_, &liquid_, &grains_, &liquid_light_, &grains_light_, &push_})
      (*f)[a].assign(size, R(0));
  }
  const ParticleSet<R>* const liquid = liquid_of(world);
  const MatterShare share{liquid ? liquid->mass / liquid->rest_volume : 1, GrainNumbers::packing};
  const GivenMatter<R> to{grid.grain_sums, volume_, grid.grain_volume};
  for_blocks_by_color(world, [&](std::size_t b) {
    for (const ParticleSet<R>& set : world.sets)
      if (set.size() > 0 && is_grains(set)) give_block(world, set, b, grid.cells, share, to);
  });
  if (grid.cells.wraps()) {
    for (std::size_t a = 0; a < 3; ++a) grid.cells.fold(grid.grain_sums[a].data()), grid.cells.fold(volume_[a].data());
    grid.cells.fold(grid.grain_volume.data());
  }
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t c = at.own; c < at.own + row_cells; ++c) grid.density[c] += grid.grain_volume[c];
  });
}

template <class R>
void Grains<R>::mix(const World<R>& world, MacGrid<R>& grid, double kick) {
  if (!any_) return;
  const ParticleSet<R>* const liquid = liquid_of(world);
  const R cell = liquid ? static_cast<R>(liquid->rest_volume / (world.dx * world.dx * world.dx)) : R(0);
  const R drag = static_cast<R>(drag_of(world) * kick), most = static_cast<R>(GrainNumbers::most_packing);
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t f = at.own; f < at.own + row_cells; ++f) {
        const auto [momentum, mass] = grid.grain_sums[a][f];
        if (!(mass > static_cast<R>(least_grains))) continue;
        const bool wet = is_known(grid.free[a][f]);
        const R own = own_[a][f] = momentum / mass, free = wet ? grid.free[a][f] : own;
        // Elastic matter and liquid are one already.
        const R other = wet ? cell * grid.sums[a][f].weight + grid.solid_sums[a][f].weight : R(0);
        // By cells, which have their images in walls.
        const std::size_t below = at.low[a] + f - at.own;
        const R part = std::min((grid.grain_volume[f] + grid.grain_volume[below]) / 2, most), pores = 1 - part,
                sum = mass + other;
        // Backward Euler of the drag; what is left of the difference of both.
        const R left = 1 / (1 + drag * part / (pores * pores) * sum / mass);
        const auto draw = [&](R of_liquid, R of_grains, R& liquid_then, R& grains_then) {
          const R mean = (other * of_liquid + mass * of_grains) / sum, apart = left * (of_liquid - of_grains);
          liquid_then = mean + apart * mass / sum, grains_then = mean - apart * other / sum;
        };
        draw(free, own, liquid_[a][f], grains_[a][f]);
        // Beyond a surface grains are dry: the pressure's slope is that of their wet part.
        const R wet_part = 1 / inverse_theta(grid.depth[f], grid.depth[below]);
        draw(grid.lightness[a][f], volume_[a][f] / mass * wet_part, liquid_light_[a][f], grains_light_[a][f]);
        grid.free[a][f] = flux_[a][f] = pores * liquid_[a][f] + part * grains_[a][f];
        grid.lightness[a][f] = pores * liquid_light_[a][f] + part * grains_light_[a][f];
      }
  });
  for (std::size_t a = 0; a < 3; ++a) {
    for (Faces* f : {&volume_, &own_, &flux_, &liquid_, &grains_, &liquid_light_, &grains_light_}) grid.wrap((*f)[a]);
    grid.wrap(grid.free[a]), grid.wrap(grid.lightness[a]), grid.wrap(grid.grain_sums[a]);
  }
}

template <class R>
void Grains<R>::part(World<R>& world, MacGrid<R>& grid, const Vec3d& gained, const LargeVector<R>& lasts,
                     Pushes<R>& pushes) {
  if (!any_) return;
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t f = at.own + l, below = at.low[a] + l;
        const R mass = grid.grain_sums[a][f].weight;
        if (!(mass > static_cast<R>(least_grains))) continue;
        // Damping, fields and viscosity act on both.
        const R changed = grid.free[a][f] - flux_[a][f];
        R& velocity = grid.velocity[a][f];
        const bool pressed = is_known(velocity) && grid.open[a][f] > R(0);
        const R slope = pressed ? (grid.free[a][f] - velocity) / grid.lightness[a][f] : R(0);
        const R liquid = liquid_[a][f] + changed, lightness = volume_[a][f] / mass;
        R dragged = grains_[a][f] - grains_light_[a][f] * slope - own_[a][f], push = 0;
        if (pressed) {
          velocity = liquid - liquid_light_[a][f] * slope;
          dragged += lightness * (grid.impulse[f] - grid.impulse[below]);
          push = -lightness * (lasts[f] - lasts[below]);
        }
        // The drag lasts as far as it bears their weight in the liquid.
        push_[a][f] = push + lasting(dragged, -(static_cast<R>(gained[static_cast<int>(a)]) + push));
        grid.free[a][f] =
            grid.sums[a][f].weight > R(0) || grid.solid_sums[a][f].weight > R(0) ? liquid : unknown_velocity<R>;
        own_[a][f] = grains_[a][f] + changed - grains_light_[a][f] * slope - own_[a][f];
      }
  });
  for (std::size_t a = 0; a < 3; ++a) grid.wrap(grid.velocity[a]), grid.wrap(grid.free[a]);
  mirror_along_walls(grid, own_), mirror_along_walls(grid, push_);
  for (std::size_t s = 0; s < world.sets.size(); ++s)
    if (is_grains(world.sets[s])) give_changes(world, world.sets[s], grid.cells, own_, push_, pushes[s]);
}

template class Grains<float>;
template class Grains<double>;

}  // namespace dreampm
