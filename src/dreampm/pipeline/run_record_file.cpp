#include "dreampm/pipeline/run_record_file.h"

#include <algorithm>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/base/seconds_since.h"
#include "dreampm/scene/emit.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {

template <class R>
std::map<std::string, Pose> poses_of(const World<R>& world) {
  std::map<std::string, Pose> poses;
  for (const Collider& c : world.colliders)
    // Paths and poses at the start are those of the scene.
    if (c.rigid || (!c.path && !(c.pose == Pose{}))) poses[c.name] = c.pose;
  return poses;
}

template <class R>
void RunRecordFile<R>::begin(const Vec3d& shift) {
  record_ = RunRecord::for_this_build();
  record_.shift = shift;
}

template <class R>
void RunRecordFile<R>::go_on(const BackendChoice& before) {
  record_ = RunRecord::load(folder_ / "run.json");
  const int frame = engine_.world().frame;
  std::erase_if(record_.frames, [&](const FrameRecord& f) { return f.frame > frame; });
  std::erase_if(record_.earlier_backends, [&](const EarlierBackend& b) { return b.last_frame >= frame; });
  if (before != choice_of(engine_.backend())) record_.earlier_backends.push_back({before.backend, before.isa, frame});
}

template <class R>
void RunRecordFile<R>::describe(const model::Scene& scene, const SceneSource& source, const std::string& scene_hash,
                                const InitialState& start) {
  record_.scene = source.path;
  record_.variant = source.variant;
  record_.scene_hash = scene_hash;
  record_.machine = this_machine(std::string(engine_.backend().isa()), thread_count());
  record_.particles = start.particles();
  record_.spacing = scene.space.spacing;
  record_.dx = engine_.world().dx;
  record_.backend = std::string(engine_.backend().name());
  for (const std::string& w : start.warnings)
    if (std::find(record_.warnings.begin(), record_.warnings.end(), w) == record_.warnings.end())
      record_.warnings.push_back(w);
  record_.probes.clear();
  for (const model::Probe& p : scene.probes)
    record_.probes[p.name] = std::visit([]<class P>(const P&) { return std::string(P::type); }, p.form);
  record_.bodies.clear();
  for (const BodyRange& b : start.bodies) record_.bodies.push_back({b.name, b.first_id, b.count});
  // Until it ends it may be killed at any time. What later stages made is of the run before.
  for (auto& [name, stage] : record_.stages) stage.status.reset(), stage.cause.reset();
  record_.end_stage("simulate", "interrupted");
  record_.stages["simulate"].settings_hash = scene::scene_hash(scene, scene::Part::particles);
  earlier_seconds_ = record_.stages["simulate"].seconds.value_or(0);
  start_clock_ = std::chrono::steady_clock::now();
}

template <class R>
void RunRecordFile<R>::save() {
  lock_->keep();
  StageRecord& stage = record_.stages["simulate"];
  stage.seconds = earlier_seconds_ + seconds_since(start_clock_);
  stage.frames = record_.frames.size();
  stage.particle_steps = totals_.particle_steps();
  stage.peak_memory_bytes = peak_memory_bytes();
  record_.save(folder_ / "run.json");
}

template <class R>
void RunRecordFile<R>::end(const std::string& status, std::optional<std::string> cause) {
  record_.end_stage("simulate", status, std::move(cause));
  save();
}

template <class R>
void RunRecordFile<R>::end_failed(const std::string& cause) {
  if (record_.scene.empty()) return;  // nothing was begun
  try {
    end("failed", cause);
  } catch (const RunError& e) {
    warn("{}", e.what());
  }
}

template <class R>
void RunRecordFile<R>::warn_of_volume(const std::string& warning) {
  const auto known = [](const std::string& w) { return w.starts_with(swollen_warning_start); };
  if (std::any_of(record_.warnings.begin(), record_.warnings.end(), known)) return;
  warn("{}", warning);
  record_.warnings.push_back(warning);
}

template <class R>
void RunRecordFile<R>::on_frame() {
  engine_.download(MatterFields::all);  // the hash is over all of it
  const World<R>& world = std::as_const(engine_).world();
  if (const auto w = swollen_.look(world, ledger_.row())) warn_of_volume(*w);
  Hash64 hash;
  hash.add(state_hash(world));
  record_.frames.push_back(
      {world.frame, world.time, totals_.sums().substeps, hash.hex(), world.particles(), world.left, poses_of(world)});
  save();
}

template std::map<std::string, Pose> poses_of(const World<float>&);
template std::map<std::string, Pose> poses_of(const World<double>&);
template class RunRecordFile<float>;
template class RunRecordFile<double>;

}  // namespace dreampm
