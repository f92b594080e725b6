#include "dreampm/pipeline/fill_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/setup/colliders.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> columns(const std::vector<ColliderHollow>& hollows) {
  std::vector<std::string> names{"frame"};
  for (const ColliderHollow& h : hollows)
    for (const char* what : {"reachable_m3", "filled_m3", "fraction", "leaked_m3", "pockets", "pockets_m3"})
      names.push_back(h.collider + "." + what);
  return names;
}

Vec3d up_of(const model::Scene& scene) {
  return length(scene.gravity) > 0 ? normalized(-scene.gravity) : Vec3d{0, 1, 0};
}

/// A region that stands at `there`, as seen from `here`.
class SeenFrom final : public Region {
 public:
  SeenFrom(std::shared_ptr<const Region> region, const Pose& there, const Pose& here)
      : region_(std::move(region)), there_(there), here_(here) {}
  double distance(const Vec3d& p) const override { return region_->distance(there_.inverse(here_(p))); }
  Box3d bounds() const override {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const Box3d own = region_->bounds();
    Box3d all;
    if (!is_finite(own.min) || !is_finite(own.max)) {
      all.min = {-endless, -endless, -endless}, all.max = {endless, endless, endless};
      return all;
    }
    for (int c = 0; c < 8; ++c)
      all.add(here_.inverse(
          there_({c & 4 ? own.max.x : own.min.x, c & 2 ? own.max.y : own.min.y, c & 1 ? own.max.z : own.min.z})));
    return all;
  }

 private:
  std::shared_ptr<const Region> region_;
  Pose there_, here_;
};

/// The hollow of collider `c` as all stand at `poses`, in the frame of its shape.
HollowCells cells_of(std::size_t c, const ColliderRegions& regions, const std::vector<Pose>& poses, double dx,
                     const Vec3d& up) {
  ColliderRegions others;
  for (std::size_t k = 0; k < regions.size(); ++k)
    if (k != c)
      others.push_back(poses[k] == poses[c] ? regions[k] : std::make_shared<SeenFrom>(regions[k], poses[k], poses[c]));
  return hollow_cells(*hollow_of(*regions[c]), dx, poses[c].rotation.inverse()(up), others);
}

}  // namespace

ColliderRegions regions_of(const std::vector<Collider>& colliders) {
  ColliderRegions out;
  for (const Collider& c : colliders) out.push_back(c.shape);
  return out;
}

ColliderRegions regions_of(const model::Scene& scene) {
  ColliderRegions out;
  const auto is_container = [](const model::Collider& c) {
    return std::holds_alternative<ContainerShape>(c.shape.form);
  };
  if (std::none_of(scene.colliders.begin(), scene.colliders.end(), is_container)) return out;
  const Meshes meshes(Meshes::Say::keep);  // the simulation has said what there is to say
  for (const model::Collider& c : scene.colliders) out.push_back(collider_region(c, scene.space, meshes));
  return out;
}

std::vector<ColliderHollow> collider_hollows(const model::Scene& scene, const ColliderRegions& regions) {
  std::vector<ColliderHollow> out;
  const std::vector<Pose> as_given(regions.size());
  for (std::size_t c = 0; c < regions.size(); ++c)
    if (const PlacedHollow* hollow = hollow_of(*regions[c]))
      out.push_back(
          {scene.colliders.at(c).name, cells_of(c, regions, as_given, scene.space.dx(), up_of(scene)), hollow->area});
  return out;
}

HollowLines hollow_lines(const model::Scene& scene, const ColliderRegions& regions) {
  HollowLines out;
  for (const ColliderHollow& h : collider_hollows(scene, regions)) {
    const HollowCells& c = h.cells;
    out.notes.push_back(fmt::format(
        "collider {}: its hollow holds {:.4g} m^3, of which {:.4g} m^3 can be filled through a mouth of {:.3g} m^2",
        h.collider, c.volume, c.reachable, h.mouth));
    if (c.reachable == 0)
      out.warnings.push_back(fmt::format(
          "collider {}: liquid cannot enter its hollow: the mouth, or what lies behind it, is narrower than two cells "
          "of {:.3g} m; make `cut` or the hollow larger, or space.spacing smaller",
          h.collider, c.dx));
  }
  return out;
}

FillMeter::FillMeter(const model::Scene& scene, const ColliderRegions& regions)
    : hollows_(collider_hollows(scene, regions)),
      regions_(regions),
      placed_(regions.size()),
      up_(up_of(scene)),
      dx_(scene.space.dx()),
      particle_(std::pow(scene.space.spacing, 3)) {
  const Meshes meshes(Meshes::Say::keep);
  if (!hollows_.empty())
    for (const model::Collider& c : scene.colliders)
      names_.push_back(c.name), paths_.push_back(motion_path(c.motion, c.shape, scene.space.spacing, meshes));
  for (const model::Material& m : scene.materials)
    if (info_of(m).liquid) liquids_.push_back(m.name);
}

std::vector<Pose> FillMeter::poses_at(double time, const ColliderPoses& poses) const {
  std::vector<Pose> out;
  for (std::size_t c = 0; c < names_.size(); ++c) {
    const auto known = poses.find(names_[c]);
    out.push_back(known != poses.end() ? known->second : paths_[c] ? paths_[c]->pose_at(time) : Pose{});
  }
  return out;
}

void FillMeter::place(const std::vector<Pose>& poses) {
  if (poses == placed_) return;
  for (std::size_t c = 0, h = 0; c < regions_.size(); ++c) {
    if (!hollow_of(*regions_[c])) continue;
    hollows_[h++].cells = cells_of(c, regions_, poses, dx_, up_);
  }
  placed_ = poses;
}

std::vector<FillReport> FillMeter::measure(const ParticleFrame& frame, double time, const ColliderPoses& poses) {
  if (!hollows_.empty()) place(poses_at(time, poses));
  std::vector<bool> liquid;
  for (const std::string& name : frame.material_names)
    liquid.push_back(std::find(liquids_.begin(), liquids_.end(), name) != liquids_.end());
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (frame.material[i] < liquid.size() && liquid[frame.material[i]])
      points.push_back((frame.exact.empty() ? static_cast<Vec3d>(frame.position[i]) : frame.exact[i]) + frame.shift);
  std::vector<FillReport> out;
  std::vector<Vec3d> seen(points.size());
  for (const ColliderHollow& h : hollows_) {
    const auto c = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), h.collider) - names_.begin());
    for (std::size_t i = 0; i < points.size(); ++i) seen[i] = placed_[c].inverse(points[i]);
    Fill fill = fill_of(h.cells, seen, particle_);
    for (Pocket& p : fill.pockets) p.at = placed_[c](p.at);
    const double all = h.cells.reachable;
    out.push_back(
        {h.collider, all, fill.filled, all > 0 ? fill.filled / all : 0, fill.leaked, std::move(fill.pockets)});
  }
  return out;
}

FillSeries::FillSeries(const model::Scene& scene, const ColliderRegions& regions, const fs::path& folder)
    : meter_(scene, regions), file_(folder / "fill.csv") {}

void FillSeries::begin() {
  fs::remove(file_);
  if (!meter_.empty()) writer_.emplace(file_, columns(meter_.hollows()));
}

void FillSeries::resume(double time) {
  if (meter_.empty() || !fs::exists(file_)) return begin();
  writer_.emplace(file_, columns(meter_.hollows()), time);
}

void FillSeries::append(double time, int number, const ParticleFrame& frame, const ColliderPoses& poses) {
  if (!writer_) return;
  std::vector<double> row{static_cast<double>(number)};
  for (const FillReport& r : meter_.measure(frame, time, poses)) {
    double closed_in = 0;
    for (const Pocket& p : r.pockets) closed_in += p.volume;
    row.insert(row.end(),
               {r.reachable, r.filled, r.fraction, r.leaked, static_cast<double>(r.pockets.size()), closed_in});
  }
  writer_->append(time, row);
}

FrameFill frame_fill(const RunFolder& run, std::optional<int> frame) {
  const std::string folder = run.folder.string();
  FillMeter meter(run.scene, regions_of(run.scene));
  if (meter.empty()) fail_input("{}: no collider of the scene is a container: there is nothing to fill", folder);
  const auto& frames = run.record.frames;
  if (frames.empty()) fail_input("{}: has no frame yet", folder);
  const auto found = frame
                         ? std::find_if(frames.begin(), frames.end(), [&](const auto& f) { return f.frame == *frame; })
                         : std::prev(frames.end());
  if (found == frames.end())
    fail_input("{}: has no frame {}: it has {} to {}", folder, *frame, frames.front().frame, frames.back().frame);
  return {found->frame, found->time,
          meter.measure(read_particles(run.particles(found->frame)), found->time, found->poses)};
}

}  // namespace dreampm
