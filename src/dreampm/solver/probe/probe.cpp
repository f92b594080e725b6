#include "dreampm/solver/probe/probe.h"

namespace dreampm {

template <class R>
std::unique_ptr<Probe<R>> make_probe(const model::Probe& probe, const ProbeStart& start) {
  return std::visit([&](const auto& form) { return make_one<R>(form, probe.name, start); }, probe.form);
}

template std::unique_ptr<Probe<float>> make_probe(const model::Probe&, const ProbeStart&);
template std::unique_ptr<Probe<double>> make_probe(const model::Probe&, const ProbeStart&);

}  // namespace dreampm
