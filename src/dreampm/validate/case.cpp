#include "dreampm/validate/case.h"

#include <algorithm>
#include <stdexcept>

namespace dreampm::validate {

void Trial::control(std::string what, std::string_view metric, double value) {
  const auto m = std::find_if(metrics.begin(), metrics.end(),
                              [&](const Metric& x) { return x.name == metric && x.side != Metric::Side::none; });
  if (m == metrics.end()) throw std::logic_error("a control of a metric that has no gate: " + std::string(metric));
  Metric wrong = *m;
  wrong.value = value;
  controls.push_back({std::move(what), m->name, m->unit, value, m->gate, !wrong.pass()});
}

}  // namespace dreampm::validate
