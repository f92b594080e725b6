#include "dreampm/level_set/mesh_sequence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <unordered_map>

#include "dreampm/base/error.h"
#include "dreampm/geometry/nearest_on_triangle.h"
#include "dreampm/import/import.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/math/vec_hash.h"

namespace dreampm {
namespace {

/// A region between two others.
class Between final : public Region {
 public:
  Between(std::shared_ptr<const Region> a, std::shared_ptr<const Region> b, double part)
      : a_(std::move(a)), b_(std::move(b)), part_(part) {}
  double distance(const Vec3d& p) const override { return a_->distance(p) * (1 - part_) + b_->distance(p) * part_; }
  Vec3d normal(const Vec3d& p) const override {
    const Vec3d sum = a_->normal(p) * (1 - part_) + b_->normal(p) * part_;
    return length2(sum) > 0 ? normalized(sum) : a_->normal(p);
  }
  Box3d bounds() const override {
    const Box3d a = a_->bounds(), b = b_->bounds();
    return {min(a.min, b.min), max(a.max, b.max)};
  }

 private:
  std::shared_ptr<const Region> a_, b_;
  double part_;
};

/// Triangles by the cells that they come near.
class TriangleCells {
 public:
  TriangleCells(const std::vector<Vec3d>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                double cell)
      : cell_(cell) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      Box3d box;
      for (const std::uint32_t v : triangles[t]) box.add(vertices[v]);
      const Vec3d slack{cell, cell, cell};
      const Vec3i low = cell_of(box.min - slack), high = cell_of(box.max + slack);
      for (int i = low.x; i <= high.x; ++i)
        for (int j = low.y; j <= high.y; ++j)
          for (int k = low.z; k <= high.z; ++k) cells_[{i, j, k}].push_back(t);
    }
  }
  /// All that come within a cell of a place, or none.
  std::span<const std::uint32_t> near(const Vec3d& p) const {
    const auto found = cells_.find(cell_of(p));
    return found == cells_.end() ? std::span<const std::uint32_t>() : std::span<const std::uint32_t>(found->second);
  }

 private:
  Vec3i cell_of(const Vec3d& p) const {
    const auto at = [&](double x) { return static_cast<std::int32_t>(std::floor(x / cell_)); };
    return {at(p.x), at(p.y), at(p.z)};
  }
  double cell_;
  std::unordered_map<Vec3i, std::vector<std::uint32_t>, Vec3iHash> cells_;
};

/// A level set of the sequence, and where its triangles are.
struct Still {
  std::shared_ptr<const Region> region;
  TriangleCells cells;
};

}  // namespace

struct MeshSequence::Impl {
  std::vector<std::string> files;
  std::vector<std::vector<Vec3d>> vertices;  ///< m, by file
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<double> moves;  ///< m: of the farthest vertex from each file to the next
  std::vector<int> parts;     ///< level sets from each file to the next
  double fps, voxel, reach;
  mutable std::mutex mutex;
  mutable std::map<std::pair<std::size_t, int>, std::shared_ptr<const Still>> stills;  ///< the last few

  /// The place of a time in the sequence: `part` of the way from file `from` to the next one.
  struct Place {
    std::size_t from;
    double part;
  };
  Place place(double time) const {
    const double at = std::clamp(time * fps, 0.0, static_cast<double>(moves.size()));
    const auto from = std::min(static_cast<std::size_t>(at), moves.size() - 1);
    return {from, at - static_cast<double>(from)};
  }
  bool stands(double time) const { return time < 0 || time * fps >= static_cast<double>(moves.size()); }
  std::vector<Vec3d> vertices_at(const Place& at) const {
    std::vector<Vec3d> all(vertices[0].size());
    for (std::size_t v = 0; v < all.size(); ++v)
      all[v] = vertices[at.from][v] * (1 - at.part) + vertices[at.from + 1][v] * at.part;
    return all;
  }
  /// The level set number `n` of the parts from a file to the next.
  std::shared_ptr<const Still> still(std::size_t from, int n) const {
    if (n == parts[from] && from + 1 < moves.size()) return still(from + 1, 0);
    const std::lock_guard lock(mutex);
    auto& made = stills[{from, n}];
    if (made) return made;
    Model model;
    model.vertices = vertices_at({from, static_cast<double>(n) / parts[from]});
    model.triangles = triangles;
    made = std::make_shared<const Still>(
        Still{mesh_region(model, 1, voxel, files[from], reach), TriangleCells(model.vertices, triangles, voxel)});
    const auto kept = made;
    // Time goes on; one who goes back makes them again.
    constexpr std::size_t most = 4;
    while (stills.size() > most)
      stills.erase(stills.begin()->first == std::pair{from, n} ? std::prev(stills.end()) : stills.begin());
    return kept;
  }
};

MeshSequence::MeshSequence(std::span<const std::string> files, double fps, double scale, double voxel, double reach)
    : impl_(std::make_unique<Impl>()) {
  impl_->files.assign(files.begin(), files.end());
  impl_->fps = fps, impl_->voxel = voxel, impl_->reach = reach;
  for (const std::string& file : files) {
    Model model = load_mesh(file);
    if (impl_->vertices.empty()) impl_->triangles = model.triangles;
    if (model.vertices.size() != (impl_->vertices.empty() ? model.vertices.size() : impl_->vertices[0].size()) ||
        model.triangles != impl_->triangles)
      fail_input(
          "{}: has {} vertices and {} triangles that are not those of {}: a sequence of meshes keeps its topology",
          file, model.vertices.size(), model.triangles.size(), files[0]);
    for (Vec3d& v : model.vertices) v *= scale;
    impl_->vertices.push_back(std::move(model.vertices));
  }
  for (std::size_t f = 0; f + 1 < files.size(); ++f) {
    double most = 0;
    for (std::size_t v = 0; v < impl_->vertices[f].size(); ++v)
      most = std::max(most, length(impl_->vertices[f + 1][v] - impl_->vertices[f][v]));
    impl_->moves.push_back(most);
    impl_->parts.push_back(std::max(1, static_cast<int>(std::ceil(most / voxel))));
  }
}
MeshSequence::~MeshSequence() = default;

std::shared_ptr<const Region> MeshSequence::at(double time) const {
  const Impl::Place at = impl_->place(time);
  const double n = at.part * impl_->parts[at.from];
  const int before = std::min(static_cast<int>(n), impl_->parts[at.from] - 1);
  return std::make_shared<Between>(impl_->still(at.from, before)->region, impl_->still(at.from, before + 1)->region,
                                   n - before);
}

Vec3d MeshSequence::velocity(const Vec3d& p, double time) const {
  if (impl_->stands(time)) return {};
  const Impl::Place at = impl_->place(time);
  const double n = at.part * impl_->parts[at.from];
  const auto nearest = impl_->still(at.from, static_cast<int>(std::lround(n)));
  const Vec3d foot = p - nearest->region->normal(p) * nearest->region->distance(p);
  const std::vector<Vec3d>&from = impl_->vertices[at.from], &to = impl_->vertices[at.from + 1];
  double least = std::numeric_limits<double>::infinity();
  Vec3d velocity{};
  const auto look_at = [&](std::uint32_t t) {
    const auto& [a, b, c] = impl_->triangles[t];
    const auto now = [&](std::uint32_t v) { return from[v] * (1 - at.part) + to[v] * at.part; };
    const Vec3d corners[3] = {now(a), now(b), now(c)};
    const Vec3d w = nearest_weights(p, corners[0], corners[1], corners[2]);
    const Vec3d off = corners[0] * w.x + corners[1] * w.y + corners[2] * w.z - p;
    if (!(length2(off) < least)) return;
    least = length2(off);
    velocity = ((to[a] - from[a]) * w.x + (to[b] - from[b]) * w.y + (to[c] - from[c]) * w.z) * impl_->fps;
  };
  const auto near = nearest->cells.near(foot);
  for (const std::uint32_t t : near) look_at(t);
  // Far inside the distance is clamped, and there is no foot.
  if (near.empty())
    for (std::uint32_t t = 0; t < impl_->triangles.size(); ++t) look_at(t);
  return velocity;
}

double MeshSequence::fastest(double from, double to) const {
  double most = 0;
  if (to <= 0 || impl_->stands(std::max(from, 0.0))) return 0;
  for (std::size_t f = impl_->place(from).from; f <= impl_->place(to).from; ++f)
    most = std::max(most, impl_->moves[f] * impl_->fps);
  return most;
}

double MeshSequence::farthest(double from, double to) const {
  const Impl::Place a = impl_->place(std::min(from, to)), b = impl_->place(std::max(from, to));
  double sum = impl_->moves[b.from] * b.part - impl_->moves[a.from] * a.part;
  for (std::size_t f = a.from; f < b.from; ++f) sum += impl_->moves[f];
  return sum;
}

TriMesh MeshSequence::mesh(double time, const Vec3d& origin) const {
  TriMesh out;
  for (const Vec3d& v : impl_->vertices_at(impl_->place(time))) out.vertices.push_back(Vec3f(v - origin));
  out.triangles = impl_->triangles;
  return out;
}

}  // namespace dreampm
