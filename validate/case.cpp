#include "validate/case.h"

#include <algorithm>
#include <stdexcept>

namespace dreampm::validate {

void Trial::control(std::string what, std::string_view metric, double value, std::optional<double> beyond) {
  const auto m = std::find_if(metrics.begin(), metrics.end(),
                              [&](const Metric& x) { return x.name == metric && x.side != Metric::Side::none; });
  if (m == metrics.end()) throw std::logic_error("a control of a metric that has no gate: " + std::string(metric));
  const auto is_beyond = [&](double v, double bound) {
    return m->side == Metric::Side::at_most ? v > bound : v < bound;
  };
  if (beyond && !is_beyond(*beyond, m->gate)) throw std::logic_error("a control's bound within its gate: " + m->name);
  Metric wrong = *m;
  wrong.value = value;
  const bool fails = !wrong.pass() && (!beyond || is_beyond(value, *beyond));
  controls.push_back({std::move(what), m->name, m->unit, value, m->gate, m->side, beyond, fails});
}

void Trial::set_up(std::string_view scene, std::string text) {
  if (std::none_of(set_ups.begin(), set_ups.end(), [&](const SetUp& s) { return s.scene == scene; }))
    set_ups.push_back({std::string(scene), std::move(text)});
}

}  // namespace dreampm::validate
