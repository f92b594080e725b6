// Matter that leaves by open walls: said, so that nothing vanishes without a word.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "dreampm/model/scene.h"
#include "dreampm/play/model/action.h"
#include "dreampm/play/model/play_model.h"

namespace dreampm::play {
namespace {

/// s of playing between two messages about the same stream.
constexpr double loss_pause = 0.5;
/// s of playing without a loss after which counting begins anew.
constexpr double lossless = 5;

constexpr std::array<const char*, 6> side_names{"the wall x_min", "the wall x_max", "the bottom",
                                                "the top",        "the wall z_min", "the wall z_max"};

}  // namespace

std::string lost_text(const std::array<std::uint64_t, 6>& by_side) {
  std::uint64_t sum = 0;
  std::string by;
  for (std::size_t side = 0; side < by_side.size(); ++side)
    if (by_side[side] > 0) sum += by_side[side], by += fmt::format("{}{}", by.empty() ? "" : " and ", side_names[side]);
  return sum == 0 ? "" : fmt::format("{} particle{} left by {}", grouped(sum), sum == 1 ? "" : "s", by);
}

void PlayModel::see_losses() {
  const model::Space& space = simulation->scene().model().space;
  if (std::none_of(space.walls.begin(), space.walls.end(), [](const auto& w) { return w.type == WallType::open; }))
    return;
  std::array<std::uint64_t, 6> out{};
  for (const std::string& material : simulation->scene().materials())
    simulation->visit(material, {}, [&](const ParticleBatch& some) {
      for (const Vec3d& x : some.position)
        for (int a = 0; a < 3; ++a)
          out[std::size_t(2 * a)] += x[a]<space.min[a], out[std::size_t(2 * a + 1)] += x[a]> space.end()[a];
    });
  const std::uint64_t gone = simulation->counts().left;
  const std::uint64_t more = gone - std::min(gone, losses.seen);
  if (more > 0) {
    if (clock.played > losses.last + lossless) losses.gone = {};
    // By the side beyond which most were: they are taken out a box's width behind it.
    const auto side = std::max_element(losses.out.begin(), losses.out.end()) - losses.out.begin();
    losses.gone[std::size_t(side)] += more, losses.all[std::size_t(side)] += more;
    losses.last = clock.played, losses.unsaid = true;
  }
  losses.seen = gone, losses.out = out;
  if (!losses.unsaid || clock.played < losses.said + loss_pause) return;
  losses.said = clock.played, losses.unsaid = false;
  say(fmt::format("{}: {}", lost_text(losses.gone), history.can_undo() ? "Undo" : "Rewind"));
}

void PlayModel::forget_losses() {
  losses = {.all = losses.all};
  losses.seen = simulation->counts().left;
}

}  // namespace dreampm::play
