#include "dreampm/run/probe_set.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/scene/emit.h"
#include "dreampm/setup/place.h"

namespace dreampm {
namespace {

/// Part of a period by which a step may end early and still count: sums of steps are rounded.
constexpr double slack = 1e-6;

double samples_until(double time, double rate) { return std::floor(time * rate + slack); }

}  // namespace

template <class R>
ProbeSet<R>::ProbeSet(const model::Scene& scene, const InitialState& start, const std::string& file) {
  ProbeStart at{start.world, start.seeds, {}, scene.space.spacing, mesh_regions()};
  for (std::size_t b = 0; b < start.bodies.size(); ++b)
    at.bodies.push_back({start.bodies[b].name, index_of(scene.materials, scene.bodies[b].material),
                         start.bodies[b].first_id, start.bodies[b].count});
  std::vector<std::string> errors;
  for (const model::Probe& p : scene.probes) try {
      all_.push_back({p.name, scene::probe_hash(scene, p), p.rate, make_probe<R>(p, at)});
    } catch (const InputError& e) {
      errors.push_back(fmt::format("{}: error: {}", place(file, scene, p), e.what()));
    }
  if (!errors.empty()) throw InputError(fmt::format("{}", fmt::join(errors, "\n")));
}

template <class R>
void ProbeSet<R>::resume(const ProbeMemories& memories, double time) {
  for (One& one : all_) {
    const auto found = memories.find(one.name);
    if (found == memories.end())
      fail_input("probe {} is not in the checkpoint: start again without --resume to measure it", one.name);
    if (found->second.identity != one.identity)
      fail_input("probe {} was another one when the checkpoint was written: start again without --resume", one.name);
    one.probe->restore(found->second.values);
    passed(one, time);
  }
}

template <class R>
double ProbeSet<R>::next() const {
  double first = std::numeric_limits<double>::infinity();
  for (const One& one : all_)
    if (one.rate > 0) first = std::min(first, (one.taken + 1 - slack) / one.rate);
  return first;
}

template <class R>
void ProbeSet<R>::accumulate(const StepSums& step) {
  for (One& one : all_) one.probe->accumulate(step);
}

template <class R>
bool ProbeSet<R>::is_due(const One& one, double time, bool frame_done) {
  return one.rate > 0 ? samples_until(time, one.rate) > one.taken : frame_done;
}

template <class R>
void ProbeSet<R>::passed(One& one, double time) {
  one.taken = samples_until(time, one.rate);
}

template <class R>
MatterFields ProbeSet<R>::fields_due(double time, bool frame_done) const {
  MatterFields fields = MatterFields::none;
  for (const One& one : all_)
    if (is_due(one, time, frame_done)) fields = fields | one.probe->fields();
  return fields;
}

template <class R>
ProbeMemories ProbeSet<R>::memories() const {
  ProbeMemories all;
  for (const One& one : all_) all[one.name] = {one.identity, one.probe->memory()};
  return all;
}

template class ProbeSet<float>;
template class ProbeSet<double>;

}  // namespace dreampm
