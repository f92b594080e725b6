#include "dreampm/play/report/report_looks.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "dreampm/error.h"

namespace dreampm::play {
namespace {

// The bounds are those of the report but where it says otherwise. What is elastic does not use V;
// 0.05 is what the report's program had.
constexpr ReportLook diy_looks[] = {
    {"liquid", "Liquid", "V = 0: keeps its volume, and no shape", 0, -250, 45, false},
    {"honey", "Honey", "a small V: flows until its own weight no longer moves it", 0.1, -250, 45, false},
    {"stone", "Stone", "the largest V and wide bounds: keeps its shape where it falls", 0.7, -400, 100, false},
    {"elastic", "Elastic", "Elastic Object: flicks back into its shape, and leaps", 0.05, -250, 45, true},
};

}  // namespace

std::span<const ReportLook> report_looks() { return diy_looks; }

const ReportLook& report_look(std::string_view name) {
  const auto look =
      std::find_if(std::begin(diy_looks), std::end(diy_looks), [&](const ReportLook& l) { return l.name == name; });
  if (look != std::end(diy_looks)) return *look;
  std::string names;
  for (const ReportLook& l : diy_looks) names += fmt::format("{}{}", names.empty() ? "" : ", ", l.name);
  throw InputError(fmt::format("look: no look '{}'; there are {}", name, names));
}

}  // namespace dreampm::play
