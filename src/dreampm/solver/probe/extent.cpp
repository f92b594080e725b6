// From where to where matter reaches along an axis [m], spray left out: the outermost one-cell
// slabs that hold at least half of a full layer. A full layer is one cell thick and as wide as the
// matter reaches across; across is the other horizontal axis, for y the one along which the matter
// is narrower. The ends are those of the particles in the slabs, each of which stands for a cube of
// its volume at rest, cut at the closed walls: a particle may lie nearer to one than half its cube.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "dreampm/solver/probe/probe.h"

namespace dreampm {
namespace {

/// The box of the walls, without end where one is open or the axis periodic.
template <class R>
Box3d closed_box(const World<R>& w) {
  Box3d box = box_of(w);
  for (int a = 0; a < 3; ++a) {
    const auto low = static_cast<std::size_t>(2 * a);
    if (w.walls[low].type == WallType::open) box.min[a] = -std::numeric_limits<double>::infinity();
    if (w.walls[low + 1].type == WallType::open) box.max[a] = std::numeric_limits<double>::infinity();
  }
  return box;
}

template <class R>
class Extent final : public Probe<R> {
 public:
  explicit Extent(const ExtentProbe& spec) : axis_(spec.axis), material_(spec.material) {}

  std::vector<std::string> columns() const override { return {"min", "max"}; }
  MatterFields fields() const override { return MatterFields::position | MatterFields::motion; }

  std::optional<std::vector<double>> sample(const ProbeContext<R>& now) override {
    const World<R>& w = now.world;
    struct Slab {
      double volume = 0, min = std::numeric_limits<double>::infinity(), max = -min;
    };
    const Box3d closed = closed_box(w);
    std::map<int, Slab> slabs;
    Box3d reach;
    for (std::size_t s = 0; s < w.sets.size(); ++s) {
      if (!material_.empty() && w.sets[s].name != material_) continue;
      const double half = edge_of(w.sets[s]) / 2;
      now.particles(s).for_each([&](std::size_t p, const Vec3d& x) {
        Slab& slab = slabs[static_cast<int>(std::floor((x[axis_] - w.origin[axis_]) / w.dx))];
        slab.volume += w.sets[s].rest_volume * static_cast<double>(now.motion.sets[s].volume_ratio[p]);
        Vec3d low, high;
        for (int a = 0; a < 3; ++a) {  // never short of the particle itself
          low[a] = std::max(x[a] - half, std::min(x[a], closed.min[a]));
          high[a] = std::min(x[a] + half, std::max(x[a], closed.max[a]));
        }
        slab.min = std::min(slab.min, low[axis_]);
        slab.max = std::max(slab.max, high[axis_]);
        reach.add(low);
        reach.add(high);
      });
    }
    const Vec3d wide = reach.size();
    const double across = axis_ == 0 ? wide.z : axis_ == 2 ? wide.x : std::min(wide.x, wide.z);
    const double enough = 0.5 * across * w.dx * w.dx;
    std::vector<double> ends(2, std::numeric_limits<double>::quiet_NaN());
    for (auto s = slabs.begin(); s != slabs.end() && std::isnan(ends[0]); ++s)
      if (s->second.volume >= enough) ends[0] = s->second.min;
    for (auto s = slabs.rbegin(); s != slabs.rend() && std::isnan(ends[1]); ++s)
      if (s->second.volume >= enough) ends[1] = s->second.max;
    return ends;
  }

 private:
  int axis_;
  std::string material_;  ///< empty: all
};

}  // namespace

template <class R>
std::unique_ptr<Probe<R>> make_one(const ExtentProbe& spec, const std::string&, const ProbeStart&) {
  return std::make_unique<Extent<R>>(spec);
}
template std::unique_ptr<Probe<float>> make_one(const ExtentProbe&, const std::string&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_one(const ExtentProbe&, const std::string&, const ProbeStart&);

}  // namespace dreampm
