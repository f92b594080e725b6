#include "dreampm/play/model/losses.h"

#include <fmt/format.h>

#include <algorithm>

#include "dreampm/model/scene.h"
#include "dreampm/play/model/action.h"

namespace dreampm::play {
namespace {

/// s of playing between two messages about losses that others came between.
constexpr double pause_of_messages = 0.5;
/// s of playing without a loss after which counting begins anew.
constexpr double pause_of_stream = 5;

constexpr std::array<const char*, 6> names_of_sides{"the wall x_min", "the wall x_max", "the bottom",
                                                    "the top",        "the wall z_min", "the wall z_max"};

CountBySide count_outside(const Simulation& simulation) {
  CountBySide out{};
  const model::Space& space = simulation.scene().model().space;
  for (const std::string& material : simulation.scene().materials())
    simulation.visit(material, {}, [&](const ParticleBatch& some) {
      for (const Vec3d& x : some.position)
        for (int a = 0; a < 3; ++a) {
          if (x[a] < space.min[a]) ++out[static_cast<std::size_t>(2 * a)];
          if (x[a] > space.end()[a]) ++out[static_cast<std::size_t>(2 * a + 1)];
        }
    });
  return out;
}

}  // namespace

std::string lost_text(const CountBySide& by_side) {
  std::uint64_t sum = 0;
  std::string by;
  for (std::size_t side = 0; side < by_side.size(); ++side)
    if (by_side[side] > 0)
      sum += by_side[side], by += fmt::format("{}{}", by.empty() ? "" : " and ", names_of_sides[side]);
  return sum == 0 ? "" : fmt::format("{} particle{} left by {}", grouped(sum), sum == 1 ? "" : "s", by);
}

void Losses::count(const Simulation& simulation, double played) {
  const auto& walls = simulation.scene().model().space.walls;
  if (std::none_of(walls.begin(), walls.end(), [](const auto& w) { return w.type == WallType::open; })) return;
  const std::uint64_t gone = simulation.counts().left, more = gone - std::min(gone, seen);
  if (more > 0) {
    if (played > last + pause_of_stream) stream = {}, message.clear();
    // By the side beyond which most were: they are taken out a box's width behind it.
    const auto side = static_cast<std::size_t>(std::max_element(outside.begin(), outside.end()) - outside.begin());
    stream[side] += more, all[side] += more;
    last = played, has_news = true;
  }
  seen = gone, outside = count_outside(simulation);
}

void Losses::forget_stream(const Simulation& simulation) {
  *this = {.all = all};
  seen = simulation.counts().left;
}

bool Losses::may_begin(double played) const { return played >= began + pause_of_messages; }

}  // namespace dreampm::play
