#include "dreampm/export/formats.h"

namespace dreampm::exchange {

const std::vector<Format>& formats() {
#define DM_ROW(name) name##_format(),
  static const std::vector<Format> all{DM_EXPORT_FORMATS(DM_ROW)};
#undef DM_ROW
  return all;
}

}  // namespace dreampm::exchange
