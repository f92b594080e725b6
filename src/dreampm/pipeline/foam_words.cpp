// What became of foam, in words.
#include <fmt/format.h>

#include "dreampm/pipeline/foam_stage.h"

namespace dreampm {
namespace {

/// "84 k", "3.2 k", "512".
std::string short_count(std::uint64_t n) {
  const auto x = static_cast<double>(n);
  if (n < 1000) return fmt::format("{}", n);
  if (n < 10000) return fmt::format("{:.1f} k", x / 1e3);
  if (n < 1000000) return fmt::format("{:.0f} k", x / 1e3);
  return fmt::format("{:.1f} M", x / 1e6);
}

std::string share(std::uint64_t part, std::uint64_t all) {
  return fmt::format("{:.0f} %", 100 * static_cast<double>(part) / static_cast<double>(all));
}

/// The frames between the first and the last eighth of what was emitted, and where that was.
std::string where(const std::vector<FoamRecord>& list, std::uint64_t all) {
  std::uint64_t sum = 0;
  int first = 0, last = 0;
  Vec3d place;
  for (const FoamRecord& f : list) {
    sum += f.emitted();
    if (first == 0 && 8 * sum >= all) first = f.frame;
    if (last == 0 && 8 * sum >= 7 * all) last = f.frame;
    place += f.place * (static_cast<double>(f.emitted()) / static_cast<double>(all));
  }
  return fmt::format("three quarters in frames {} to {}, about [{:.3g}, {:.3g}, {:.3g}]", first, last, place.x, place.y,
                     place.z);
}

}  // namespace

std::vector<std::string> foam_lines(const RunRecord& record) {
  const auto stage = record.stages.find("foam");
  if (stage == record.stages.end() || stage->second.foam.empty()) return {};
  const std::vector<FoamRecord>& list = stage->second.foam;
  FoamRecord sum;
  for (const FoamRecord& f : list) {
    sum.crest += f.crest, sum.trapped_air += f.trapped_air, sum.vorticity += f.vorticity;
    sum.beside_walls += f.beside_walls, sum.aged += f.aged, sum.at_walls += f.at_walls, sum.outside += f.outside;
    sum.thinned += f.thinned;
  }
  const std::uint64_t all = sum.emitted();
  if (all == 0) return {"nothing was emitted: nowhere was matter fast enough"};
  std::string first = fmt::format("emitted {}: {} crest, {} trapped air, {} vorticity; {} beside walls; {}",
                                  short_count(all), share(sum.crest, all), share(sum.trapped_air, all),
                                  share(sum.vorticity, all), share(sum.beside_walls, all), where(list, all));
  std::string second = fmt::format("ended: {} by age, {} at walls, {} outside", short_count(sum.aged),
                                   short_count(sum.at_walls), short_count(sum.outside));
  if (sum.thinned > 0) second += fmt::format("; {} were not emitted for foam.most", short_count(sum.thinned));
  const FoamRecord& last = list.back();
  second += fmt::format(". At frame {}: {} spray, {} foam, {} bubbles", last.frame, short_count(last.spray),
                        short_count(last.foam), short_count(last.bubbles));
  if (last.dust > 0) second += fmt::format(", {} dust", short_count(last.dust));
  return {first, second};
}

}  // namespace dreampm
