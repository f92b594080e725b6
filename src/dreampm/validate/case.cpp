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

void Trial::set_up(std::string_view scene, std::string text) {
  if (std::none_of(set_ups.begin(), set_ups.end(), [&](const SetUp& s) { return s.scene == scene; }))
    set_ups.push_back({std::string(scene), std::move(text)});
}

}  // namespace dreampm::validate
