#include "dreampm/level_set/level_set.h"

#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/brick_grid.h"
#include "dreampm/geometry/cell_fraction.h"
#include "dreampm/geometry/openness.h"
#include "dreampm/geometry/winding_number.h"
#include "dreampm/import/import.h"
#include "dreampm/level_set/shell.h"
#include "dreampm/level_set/vdb_distance.h"

namespace dreampm {
namespace {

constexpr float least_band = 3;  // voxels
constexpr double solid = 0.6;    // a winding number that no open sheet reaches, whose limit is 1/2
constexpr float shallow = 0.1f;  // voxels: what is nowhere deeper is a sheet, or smaller than the voxels can show
constexpr double certain = 0.2;  // so near to 0 or 1 around a brick without triangles, it is on one side throughout

class LevelSet final : public Region {
 public:
  LevelSet(BrickGrid field, const Vec3d& origin, double voxel, const Box3d& bounds)
      : field_(std::move(field)), origin_(origin), voxel_(voxel), bounds_(bounds) {}

  double distance(const Vec3d& p) const override { return field_.sample((p - origin_) / voxel_) * voxel_; }
  void distances(const PointColumns& points, double* to) const override {
    const double origin[3] = {origin_.x, origin_.y, origin_.z};
    field_.samples(
        points.count, [&](std::size_t a, std::size_t i) { return (points.at[a][i] - origin[a]) / voxel_; }, to);
    for (std::size_t i = 0; i < points.count; ++i) to[i] *= voxel_;
  }
  Vec3d normal(const Vec3d& p) const override { return field_.direction((p - origin_) / voxel_); }
  Box3d bounds() const override { return bounds_; }

  double volume() const {
    std::vector<double> bricks(field_.size());
    parallel_for(field_.size(), 64, [&](std::size_t i) {
      const std::int32_t slot = field_.slot(i);
      if (slot < 0) {
        bricks[i] = slot == BrickGrid::inside ? BrickGrid::volume : 0;
        return;
      }
      const Vec3i low = field_.brick(i) * 8;
      double sum = 0;
      for (int v = 0; v < BrickGrid::volume; ++v) {
        const double d = field_.values()[std::size_t(slot)][std::size_t(v)];
        if (d < -0.9) sum += 1;
        if (std::abs(d) >= 0.9) continue;
        const Vec3i c = low + Vec3i{v >> 6, v >> 3 & 7, v & 7};
        const Vec3d g{field_.at(c.x + 1, c.y, c.z) - field_.at(c.x - 1, c.y, c.z),
                      field_.at(c.x, c.y + 1, c.z) - field_.at(c.x, c.y - 1, c.z),
                      field_.at(c.x, c.y, c.z + 1) - field_.at(c.x, c.y, c.z - 1)};
        sum += cell_fraction(d, normalized(g));
      }
      bricks[i] = sum;
    });
    double total = 0;
    for (const double b : bricks) total += b;
    return total * voxel_ * voxel_ * voxel_;
  }

 private:
  BrickGrid field_;
  Vec3d origin_;
  double voxel_;
  Box3d bounds_;
};

/// The mesh in voxels about `origin`, both in meters; looking outward as a whole.
TriMesh in_voxels(const Model& model, double factor, const Vec3d& origin, double voxel) {
  TriMesh local;
  local.vertices.reserve(model.vertices.size());
  for (const Vec3d& v : model.vertices) local.vertices.push_back(Vec3f((v * factor - origin) / voxel));
  local.triangles = model.triangles;
  if (enclosed_volume(model) < 0)
    for (auto& t : local.triangles) std::swap(t[1], t[2]);
  return local;
}

/// A hole wider than this part of the mesh is no fault of scanning.
constexpr double wide_hole = 0.25;

/// Returns warnings about properties of a mesh that a user of its inside may not expect.
std::vector<std::string> surprises(const Model& model, double longest, const Openness& open, const std::string& name) {
  std::vector<std::string> lines;
  if (enclosed_volume(model) < 0)
    lines.push_back(fmt::format("{}: its faces look inward; taken the other way round", name));
  if (open.widest > wide_hole * longest)
    lines.push_back(fmt::format(
        "{}: is not closed: the widest of {} holes is {:.0f} % as wide as the mesh; is the file whole? Holes "
        "are capped smoothly, but for a collider with a `thickness`",
        name, open.holes, 100 * open.widest / longest));
  return lines;
}

double longest_side(const Box3d& box) {
  const Vec3d size = box.size();
  return std::max({size.x, size.y, size.z});
}

/// A region for those who ask for bounds alone.
class BoundsOnly final : public Region {
 public:
  explicit BoundsOnly(const Box3d& box) : box_(box) {}
  double distance(const Vec3d& p) const override {
    const Vec3d half = box_.size() * 0.5, q = p - box_.center();
    return std::max({std::abs(q.x) - half.x, std::abs(q.y) - half.y, std::abs(q.z) - half.z});
  }
  Box3d bounds() const override { return box_; }

 private:
  Box3d box_;
};

/// Gives the distances their sign, and says for bricks without triangles on which side they lie.
/// Returns whether some voxel is certainly inside.
bool apply_signs(BrickGrid& field, const WindingNumber& winding) {
  enum class Side : std::uint8_t { known, outside, inside, mixed };
  std::vector<Side> sides(field.size());
  parallel_for(field.size(), 4, [&](std::size_t i) {
    if (field.slot(i) >= 0) return;
    // Away from triangles the winding number is harmonic, so it varies gently over a brick.
    const Vec3d low(field.brick(i) * 8);
    double least = 2, most = -2;
    for (int c = 0; c < 9; ++c) {
      const Vec3d at = c == 8 ? Vec3d{3.5, 3.5, 3.5} : Vec3d{7.0 * (c & 1), 7.0 * (c >> 1 & 1), 7.0 * (c >> 2)};
      const double w = winding(low + at);
      least = std::min(least, w), most = std::max(most, w);
    }
    sides[i] = most < 0.5 - certain ? Side::outside : least > 0.5 + certain ? Side::inside : Side::mixed;
  });
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (sides[i] == Side::inside) field.slot(i) = BrickGrid::inside;
    if (sides[i] == Side::mixed) field.open(i, field.band());
  }
  std::vector<std::uint8_t> has_solid(field.size());
  parallel_for(field.size(), 1, [&](std::size_t i) {
    const std::int32_t slot = field.slot(i);
    if (slot < 0) {
      has_solid[i] = slot == BrickGrid::inside;
      return;
    }
    const Vec3d low(field.brick(i) * 8);
    auto& values = field.values()[std::size_t(slot)];
    for (int v = 0; v < BrickGrid::volume; ++v) {
      const double w = winding(low + Vec3d{double(v >> 6), double(v >> 3 & 7), double(v & 7)});
      // Never -0: a voxel on debris inside is no surface.
      if (w > 0.5) values[std::size_t(v)] = -std::max(values[std::size_t(v)], 1e-3f);
      if (w > solid && values[std::size_t(v)] < -shallow) has_solid[i] = 1;
    }
  });
  return std::find(has_solid.begin(), has_solid.end(), 1) != has_solid.end();
}

/// Signs as in `exact`. Where the nearest triangle is part of the boundary, its distance is exact
/// and kept; near holes, and near pieces that lie wholly inside, the distance to the closed surface
/// takes over.
BrickGrid merged(const BrickGrid& exact, BrickGrid closed) {
  for (std::size_t i = 0; i < closed.size(); ++i)
    if (closed.slot(i) < 0 && exact.slot(i) < 0) closed.slot(i) = exact.slot(i);
  // Only debris, far from the surface: all on one side, or it would have a surface.
  for (std::size_t i = 0; i < closed.size(); ++i)
    if (closed.slot(i) == BrickGrid::outside && exact.slot(i) >= 0) closed.open(i, closed.band());
  parallel_for(closed.size(), 64, [&](std::size_t i) {
    if (closed.slot(i) < 0) return;
    auto& to = closed.values()[std::size_t(closed.slot(i))];
    if (exact.slot(i) < 0) {
      if (exact.slot(i) == BrickGrid::inside)
        for (float& v : to) v = -v;
      return;
    }
    const auto& from = exact.values()[std::size_t(exact.slot(i))];
    for (std::size_t v = 0; v < BrickGrid::volume; ++v) {
      const float d = std::abs(from[v]);
      const float t = d >= exact.band() ? 1.0f : std::clamp(2 * std::abs(d - to[v]) - 0.5f, 0.0f, 1.0f);
      to[v] = std::copysign(d + (to[v] - d) * t, from[v]);
    }
  });
  return closed;
}

}  // namespace

double thickness_of(const Model& model) {
  const double area = surface_area(model);
  return area > 0 ? 2 * std::abs(enclosed_volume(model)) / area : 0;
}

double voxel_of_wall(double thickness, double voxel) {
  return thickness < 2 * voxel ? std::min(std::max(thickness / 2, voxel / 4), voxel) : voxel;
}

std::shared_ptr<const Region> mesh_region(const TriMesh& mesh, double voxel, const std::string& name) {
  return mesh_region(model_of(mesh), 1, voxel, name);
}

std::shared_ptr<const Region> mesh_region(const Model& model, double factor, double voxel, const std::string& name,
                                          double reach) {
  if (!(voxel > 0) || !std::isfinite(voxel)) fail_input("a voxel of {} m: a length above 0 is wanted", voxel);
  if (model.triangles.empty()) fail_input("{}: has no faces", name);
  Box3d bounds = bounds_of(model);
  bounds.min *= factor, bounds.max *= factor;
  const Vec3d size = bounds.size();
  if (!((size.x / voxel + 16) * (size.y / voxel + 16) * (size.z / voxel + 16) < 0x1p31))
    fail_input(
        "{}: is {:.6g} x {:.6g} x {:.6g} m, too large for voxels of {} m; is it in millimeters? `fit` or `scale` "
        "shrink it",
        name, size.x, size.y, size.z, voxel);
  const Vec3d origin = bounds.center();
  const TriMesh local = in_voxels(model, factor, origin, voxel);
  BrickGrid exact = unsigned_distance(local, std::max(least_band, static_cast<float>(reach / voxel)));
  const bool encloses = apply_signs(exact, WindingNumber(local));
  BrickGrid field = encloses ? merged(exact, closed_distance(exact)) : BrickGrid();
  auto region = std::make_shared<LevelSet>(std::move(field), origin, voxel, bounds);
  if (!encloses || !(region->volume() > 0)) {
    const double thickness = thickness_of(model) * factor;
    const bool sheet = !(thickness > 1e-6 * longest_side(bounds)) || openness(model).open_edges > 0;
    throw EnclosesNothing(
        fmt::format("{}: encloses nothing at a voxel of {} m (it is {:.6g} x {:.6g} x {:.6g} m); {}", name, voxel,
                    size.x, size.y, size.z,
                    sheet ? "a body wants a mesh with an inside, closed but for holes, and thicker than a voxel"
                          : "it is thinner than a voxel"));
  }
  return region;
}

double level_set_volume(const Region& region) {
  const auto* level_set = dynamic_cast<const LevelSet*>(&region);
  if (!level_set) fail_input("this region is no level set");
  return level_set->volume();
}

struct Meshes::Made {
  /// The file, fit, scale, voxel, reach, thickness (0: the inside).
  using Key = std::tuple<std::string, std::optional<double>, std::optional<double>, double, double, double>;
  /// Returns the file of a mesh, or of a height field with its box, for which it is another mesh.
  static std::string file_of(const MeshShape& shape) {
    if (!shape.heights) return shape.path;
    const auto& [min, max] = *shape.heights;
    return fmt::format("{} {} {} {} {} {} {}", shape.path, min.x, min.y, min.z, max.x, max.y, max.z);
  }
  struct Read {
    Model model;
    Openness open;
    bool said_of_inside = false;
  };
  std::mutex mutex;
  std::map<Key, std::weak_ptr<const Region>> regions;
  std::map<std::string, Read> files;
  Say say = Say::log;
  std::vector<std::string> warnings;

  void report(std::vector<std::string> lines) {
    for (std::string& line : lines) {
      if (say == Say::log)
        warn("{}", line);
      else
        warnings.push_back(std::move(line));
    }
  }
  /// The caller holds the mutex. `inside`: whether that of the mesh is wanted.
  const Read& read(const MeshShape& shape, bool inside) {
    const std::string& path = shape.path;
    auto known = files.find(file_of(shape));
    if (known == files.end()) {
      Read file{mesh_of(shape), {}};
      file.open = openness(file.model);
      if (!(longest_side(bounds_of(file.model)) > 0))
        fail_input("{}: encloses nothing: all its faces lie in one point", path);
      report(file.model.warnings);
      known = files.emplace(file_of(shape), std::move(file)).first;
    }
    Read& file = known->second;
    if (inside && !file.said_of_inside)
      report(surprises(file.model, longest_side(bounds_of(file.model)), file.open, path));
    file.said_of_inside = file.said_of_inside || inside;
    return file;
  }
  static double factor_of(const MeshShape& shape, const Model& model) {
    for (const auto& length : {shape.longest, shape.scale})
      if (length && (!(*length > 0) || !std::isfinite(*length)))
        fail_input("{}: a fit or scale of {}: a number above 0 is wanted", shape.path, *length);
    return shape.longest ? *shape.longest / longest_side(bounds_of(model)) : shape.scale.value_or(1);
  }
  /// One region for equal requests while it lives.
  std::shared_ptr<const Region> region(const MeshShape& shape, double voxel, double reach, double thickness) {
    const std::lock_guard lock(mutex);
    auto& slot = regions[{file_of(shape), shape.longest, shape.scale, voxel, reach, thickness}];
    if (auto made = slot.lock()) return made;
    const Model& model = read(shape, thickness == 0).model;
    const double factor = factor_of(shape, model);
    const auto made = thickness > 0 ? mesh_shell(model, factor, thickness, voxel, reach, shape.path)
                                    : mesh_region(model, factor, voxel, shape.path, reach);
    slot = made;
    return made;
  }
};

Meshes::Meshes(Say say) : made_(std::make_shared<Made>()) { made_->say = say; }

std::vector<std::string> Meshes::warnings() const {
  const std::lock_guard lock(made_->mutex);
  return made_->warnings;
}

MeshRegions Meshes::regions(double reach) const {
  return [made = made_, reach](const MeshShape& shape, double voxel, double wanted) {
    return made->region(shape, voxel, std::max(reach, wanted), 0);
  };
}

MeshRegions Meshes::fine_regions() const {
  return [meshes = *this](const MeshShape& shape, double voxel, double wanted) {
    const MeshLook look = meshes.look(shape);
    const double reach = std::max(least_band * voxel, wanted);
    if (!look.thickness || !(*look.thickness < 2 * voxel)) return meshes.made_->region(shape, voxel, wanted, 0);
    double fine = voxel_of_wall(*look.thickness, voxel);
    // A large mesh takes what memory it may.
    constexpr double most_in_band = 1e8, most_in_box = 1e9;
    const Vec3d size = look.bounds.size();
    while (fine < voxel && (2 * look.area * reach / (fine * fine * fine) > most_in_band ||
                            size.x * size.y * size.z / (fine * fine * fine) > most_in_box))
      fine *= 1.1;
    return meshes.made_->region(shape, std::min(fine, voxel), reach, 0);
  };
}

MeshRegions Meshes::shells(double thickness, double reach) const {
  return [made = made_, thickness, reach](const MeshShape& shape, double voxel, double wanted) {
    return made->region(shape, voxel, std::max(reach, wanted), thickness);
  };
}

MeshRegions Meshes::boxes() const {
  return [meshes = *this](const MeshShape& shape, double, double) -> std::shared_ptr<const Region> {
    return std::make_shared<BoundsOnly>(meshes.look(shape).bounds);
  };
}

MeshLook Meshes::look(const MeshShape& shape) const {
  const std::lock_guard lock(made_->mutex);
  const Made::Read& file = made_->read(shape, false);
  const double factor = Made::factor_of(shape, file.model);
  MeshLook out{bounds_of(file.model), {}, {}, surface_area(file.model) * factor * factor, file.model.triangles.size()};
  out.bounds.min *= factor, out.bounds.max *= factor;
  if (file.open.open_edges == 0 && file.model.parts == 1)
    out.volume = std::abs(enclosed_volume(file.model)) * factor * factor * factor;
  if (const double thickness = thickness_of(file.model); thickness > 0) out.thickness = thickness * factor;
  return out;
}

MeshRegions mesh_regions() { return Meshes(Meshes::Say::log).regions(); }

}  // namespace dreampm
