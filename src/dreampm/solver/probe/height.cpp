// The height of the free surface above (x, z): the highest level at which a window one cell high,
// in a column two cells wide, is half full. A flat surface is measured exactly; a film thinner than
// a cell too, for below the floor all counts as full; a single drop fills no window by half and is
// no surface.
#include <algorithm>
#include <cmath>

#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

/// The part of [x - h/2, x + h/2] that lies in [low, high].
double overlap(double x, double h, double low, double high) {
  return std::max(0.0, std::min(x + h / 2, high) - std::max(x - h / 2, low)) / h;
}

template <class R>
class Height final : public Probe<R> {
 public:
  explicit Height(const HeightProbe& spec) : at_{spec.x, 0, spec.z} {}

  std::vector<std::string> columns() const override { return {"height"}; }
  MatterFields fields() const override { return MatterFields::position | MatterFields::motion; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    const World<R>& w = now.world;
    Box3d column{at_ - Vec3d{w.dx, 0, w.dx}, at_ + Vec3d{w.dx, 0, w.dx}};
    const Box3d box = box_of(w);
    for (const int a : {0, 2}) {
      const auto low = static_cast<std::size_t>(2 * a);
      if (w.walls[low].type != WallType::open) column.min[a] = std::max(column.min[a], box.min[a]);
      if (w.walls[low + 1].type != WallType::open) column.max[a] = std::min(column.max[a], box.max[a]);
    }
    return std::vector<double>{surface(filled(now, column, box.min.y), column, box.min.y, w.dx)};
  }

 private:
  static constexpr int slices = 8;  // a cell

  /// The matter [m^3] in slices of the column, upwards from the floor.
  std::vector<double> filled(const ProbeContext<R>& now, const Box3d& column, double floor) const {
    const double slice = now.world.dx / slices;
    std::vector<double> volume;
    for (std::size_t s = 0; s < now.world.sets.size(); ++s) {
      const auto& set = now.world.sets[s];
      const double h = edge_of(set);
      now.particles(s).for_each([&](std::size_t p, const Vec3d& place) {
        const Vec3d x = at_ + nearest_copy(now.world, place - at_);
        const double share = overlap(x.x, h, column.min.x, column.max.x) * overlap(x.z, h, column.min.z, column.max.z);
        if (share == 0) return;
        const double v = share * set.rest_volume * static_cast<double>(now.motion.sets[s].volume_ratio[p]);
        // Matter that reaches below the floor belongs to the first slice.
        const int first = std::max(0, static_cast<int>(std::floor((x.y - h / 2 - floor) / slice)));
        const int last = std::max(first, static_cast<int>(std::floor((x.y + h / 2 - floor) / slice)));
        if (volume.size() <= static_cast<std::size_t>(last)) volume.resize(static_cast<std::size_t>(last) + 1);
        double rest = 1;
        for (int i = last; i > first; --i) {
          const double part = overlap(x.y, h, floor + i * slice, floor + (i + 1) * slice);
          volume[static_cast<std::size_t>(i)] += v * part;
          rest -= part;
        }
        volume[static_cast<std::size_t>(first)] += v * rest;
      });
    }
    return volume;
  }

  double surface(const std::vector<double>& volume, const Box3d& column, double floor, double dx) const {
    const double slice = dx / slices;
    const double full = (column.max.x - column.min.x) * (column.max.z - column.min.z) * slice;
    const int n = static_cast<int>(volume.size()), half = slices / 2;
    const auto slice_at = [&](int i) { return i < 0 ? full : i < n ? volume[static_cast<std::size_t>(i)] : 0.0; };
    // How full the window is that reaches half a cell below and above the foot of slice i.
    const auto window = [&](int i) {
      double sum = 0;
      for (int k = i - half; k < i + half; ++k) sum += slice_at(k);
      return sum / (full * slices);
    };
    double above = 0;
    for (int i = n + half; i >= 0; --i) {
      const double here = window(i);
      if (here >= 0.5) return floor + (i + (here > above ? (here - 0.5) / (here - above) : 0)) * slice;
      above = here;
    }
    return floor;
  }

  Vec3d at_;
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const HeightProbe& spec, const std::string&, const ProbeStart&) {
  return std::make_unique<Height<R>>(spec);
}
template std::unique_ptr<Probe<float>> make_one(const HeightProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const HeightProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
