#include "dreampm/surface/surface.h"

#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/surface/attributes.h"
#include "dreampm/surface/drop_shapes.h"
#include "dreampm/surface/drops.h"
#include "dreampm/surface/field.h"
#include "dreampm/surface/kernels.h"
#include "dreampm/surface/overlap.h"
#include "dreampm/surface/smooth.h"

namespace dreampm {
namespace {

using namespace surface;

constexpr int kStepsPerSmooth = 30;
/// Air between liquid and a solid that is none, in spacings: particles rest up to a spacing before
/// it.
constexpr float contact_gap = 1;

void check(const SurfaceInput& in, const SurfaceSettings& s, float voxel) {
  if (!(in.spacing > 0) || !std::isfinite(in.spacing))
    fail_input("surface: spacing {} is not a length above 0 m", in.spacing);
  if (!(voxel >= in.spacing / 8 && voxel <= 2 * in.spacing))
    fail_input("surface: voxel {} m is out of range: use {} to {} m (an eighth of the spacing to twice it)", voxel,
               in.spacing / 8, 2 * in.spacing);
  if (s.smooth < 0 || s.smooth > 10) fail_input("surface: smooth {} is out of range: use 0 to 10", s.smooth);
  if (!(s.support >= 2.5f && s.support <= 6))
    fail_input("surface: support {} is out of range: use 2.5 to 6 spacings", s.support);
  if (!(s.overlap >= 0 && s.overlap <= 1))
    fail_input("surface: overlap {} is out of range: use 0 to 1 spacings", s.overlap);
  if (!in.velocities.empty() && in.velocities.size() != in.positions.size())
    fail_input("surface: {} velocities for {} positions: give one each, or none", in.velocities.size(),
               in.positions.size());
  if (!in.remaining.empty() && in.remaining.size() != in.positions.size())
    fail_input("surface: {} shares that remain for {} positions: give one each, or none", in.remaining.size(),
               in.positions.size());
  for (int a = 0; a < 3; ++a) {
    const auto side = static_cast<std::size_t>(2 * a);
    if (in.is_wall[side] && in.is_wall[side + 1] && !(in.walls.max[a] > in.walls.min[a]))
      fail_input("surface: walls at {} and {} m leave no room on axis {}", in.walls.min[a], in.walls.max[a], "xyz"[a]);
  }
  const float far = surface_reach * in.spacing;  // cells are counted in 21 bits
  for (std::size_t i = 0; i < in.positions.size(); ++i) {
    const Vec3f& p = in.positions[i];
    if (!is_finite(p)) fail_run("surface: the position of particle {} is not a number ({}, {}, {})", i, p.x, p.y, p.z);
    if (std::abs(p.x) > far || std::abs(p.y) > far || std::abs(p.z) > far)
      fail_run("surface: particle {} at ({}, {}, {}) m is too far from the origin for a spacing of {} m", i, p.x, p.y,
               p.z, in.spacing);
    if (!in.velocities.empty() && !is_finite(in.velocities[i]))
      fail_run("surface: the velocity of particle {} is not a number", i);
  }
}

CellGrid cells_of(const std::vector<Kernel>& kernels, float size) {
  std::vector<Vec3f> centers(kernels.size());
  for (std::size_t i = 0; i < kernels.size(); ++i) centers[i] = kernels[i].center;
  return CellGrid(centers, size);
}

/// Returns the smoothing that each vertex bears: as the kernels around it allow, less on small
/// bodies.
std::vector<float> bearing(const QuadMesh& quads, const Bodies& bodies, const std::vector<Kernel>& kernels,
                           const CellGrid& centers) {
  std::vector<float> bear(quads.vertices.size(), 1.0f);
  const float radius = 0.5f * centers.size;
  parallel_for(bear.size(), 1024, [&](std::size_t v) {
    const float of_body = smoothing_share(bodies.particles[static_cast<std::size_t>(bodies.of_vertex[v])]);
    const Vec3f x = quads.vertices[v], reach{radius, radius, radius};
    float sum = 0, weight = 0;
    const Vec3i low = lattice_cell(x - reach, centers.size), high = lattice_cell(x + reach, centers.size);
    for_rows(centers, low, high, [&](std::size_t cell, std::size_t end) {
      for (std::uint32_t i = centers.first[cell]; i < centers.first[end]; ++i) {
        const Kernel& k = kernels[centers.order[i]];
        const float t = 1 - length2(k.center - x) / (radius * radius);
        if (t > 0) sum += t * k.smoothing, weight += t;
      }
    });
    bear[v] = of_body * (weight > 0 ? sum / weight : 1);
  });
  return bear;
}

/// Smoothing moves vertices along the planes that touch a solid, and so off a round one.
void bring_to_solids(QuadMesh& quads, const Solids& solids) {
  if (quads.solid_normals.empty()) return;
  parallel_for(quads.vertices.size(), 1024, [&](std::size_t v) {
    if ((quads.touches[v] & QuadMesh::kSolid) == 0 || quads.pure_wall(v)) return;
    const Vec3f on = solids.projected(quads.vertices[v], 0);
    for (int a = 0; a < 3; ++a)
      if ((quads.touches[v] >> (2 * a) & 3) == 0) quads.vertices[v][a] = on[a];
  });
}

}  // namespace

SurfaceResult reconstruct(const SurfaceInput& in, const SurfaceSettings& settings) {
  const float h = in.spacing, voxel = settings.voxel > 0 ? settings.voxel : 0.5f * h, support = settings.support * h;
  check(in, settings, voxel);
  const auto ended = [&](std::string_view stage) {
    if (settings.ended) settings.ended(stage);
  };
  SurfaceResult result;
  const Walls walls{in.walls, in.is_wall};
  const Mirrored points = with_mirror_images(in.positions, walls, support);

  const CellGrid cells(points.points, support / 2);
  ended("sort");
  const KernelSettings kernel_settings{h, support};
  std::vector<Kernel> kernels = fit_kernels(points, cells, deep_cells(cells), kernel_settings);
  mirror_kernels(kernels, points);
  ended("moments");
  const CellGrid centers = cells_of(kernels, support / 2);
  const std::vector<std::uint8_t> deep = deep_cells(centers);
  correct_amounts(kernels, points.real, centers, deep);
  mirror_kernels(kernels, points);
  ended("volumes");

  Bounds bounds{walls, Solids(in.solids, in.origin, solid_reach * h)};
  SparseField field = make_field(kernels, centers, deep, walls, bounds.solids, {h, support, voxel});
  ended("field");
  bounds.band = SolidBand(field, bounds.solids);
  fill_solids(field, bounds.band, bounds.solids, h);
  ended("solids");
  QuadMesh quads = contour(field, bounds);
  ended("contour");
  Bodies bodies = find_bodies(field, quads, std::span(points.points).first(points.real));
  const std::vector<SmallDrop> small =
      take_small_drops(quads, bodies, std::span(points.points).first(points.real), in.velocities, in.remaining, h);
  ended("bodies");
  smooth(quads, bearing(quads, bodies, kernels, centers), {kStepsPerSmooth * settings.smooth, 0.5f * h});
  ended("smooth");
  restore_volumes(quads, bodies, h);
  bring_to_solids(quads, bounds.solids);
  ended("drops");

  result.mesh = finish(quads);
  ended("normals");
  if (!in.velocities.empty()) carry_velocities(result.mesh, points.points, in.velocities, cells);
  ended("velocities");
  result.volume = enclosed_volume(result.mesh);
  for (const SmallDrop& s : small)
    result.volume += std::pow(static_cast<double>(h), 3) * s.particles * static_cast<double>(s.remaining);
  extend(result.mesh, quads, bounds, {settings.overlap * h, contact_gap * h});
  add_small_drops(result.mesh, small, bounds, h, settings.overlap * h);
  result.small_drops = small.size();
  ended("finish");
  if (settings.keep_field) result.field = std::move(field);
  return result;
}

}  // namespace dreampm
