#include "dreampm/farm/formats.h"

#include <vector>

namespace dreampm::farm {

std::span<const Format> formats() {
#define DM_ROW(name) name##_format(),
  static const std::vector<Format> all{DM_FARM_FORMATS(DM_ROW)};
#undef DM_ROW
  return all;
}

}  // namespace dreampm::farm
