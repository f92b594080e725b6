#include "dreampm/pipeline/simulate.h"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/base/progress.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/pipeline/backend_choice.h"
#include "dreampm/pipeline/checkpoint_writer.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/pipeline/fill_report.h"
#include "dreampm/pipeline/models.h"
#include "dreampm/pipeline/run_folder.h"
#include "dreampm/pipeline/strict.h"
#include "dreampm/run/particle_observer.h"
#include "dreampm/run/probe_writer.h"
#include "dreampm/run/scene_engine.h"
#include "dreampm/scene/attributes.h"
#include "dreampm/scene/emit.h"
#include "dreampm/setup/fixed_dt.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

/// particles_NNNNNN.ply: those of an earlier run would mix with the frames of this one.
std::vector<fs::path> particle_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    int frame = 0;
    if (std::sscanf(name.c_str(), "particles_%d.ply", &frame) == 1 && name == numbered("particles", frame, ".ply"))
      files.push_back(entry.path());
  }
  return files;
}

/// Shows how far a run is.
template <class R>
class ProgressLine final : public Observer {
 public:
  ProgressLine(const Engine<R>& engine, const FrameTotals<R>& totals) : engine_(engine), totals_(totals) {}
  /// The line of frames up to `last`; it ends with what this returns.
  std::shared_ptr<Progress> show(int last) {
    auto progress = std::make_shared<Progress>("simulate: frame", static_cast<std::size_t>(last));
    progress->update(static_cast<std::size_t>(engine_.world().frame));
    progress_ = progress;
    return progress;
  }
  void on_frame() override {
    if (const auto progress = progress_.lock())
      progress->update(static_cast<std::size_t>(engine_.world().frame),
                       fmt::format("{} substeps", totals_.sums().substeps));
  }

 private:
  const Engine<R>& engine_;
  const FrameTotals<R>& totals_;
  std::weak_ptr<Progress> progress_;
};

std::vector<ProbeColumns> columns_of(const auto& probes) {
  std::vector<ProbeColumns> all;
  for (std::size_t p = 0; p < probes.size(); ++p) all.push_back({probes.name(p), probes.columns(p)});
  return all;
}

/// What a run is asked for, and what follows from it.
struct RunTask {
  const model::Scene& scene;
  const SceneSource& source;
  const SimulateOptions& options;
  std::shared_ptr<RunLock> lock;
  std::string hash = scene::scene_hash(scene, scene::Part::simulation);
  int last = options.frames.value_or(scene.time.frames);
  /// What computed the run that it goes on with; nothing where it starts again.
  std::optional<BackendChoice> earlier = options.resume ? earlier_choice(options.folder) : std::nullopt;

  BackendChoice asked() const { return {options.backend, options.isa}; }
  fs::path checkpoints() const { return options.folder / "checkpoint"; }
  fs::path particles() const { return options.folder / "particles"; }
};

/// A scene in an engine, and all that watches it and writes.
template <class R>
struct WatchedScene {
  SceneEngine<R> scene;
  FrameTotals<R> totals;
  ParticleObserver<R> particles;
  FillSeries fill;
  ProbeWriter probes;
  LedgerObserver<R> ledger;
  RunRecordFile<R> record;
  StrictObserver<R> strict;
  CheckpointWriter<R> checkpoints;
  ProgressLine<R> progress;

  /// `earlier`: what computed that which it goes on from.
  WatchedScene(const RunTask& task, InitialState start, const std::optional<BackendChoice>& earlier)
      : scene(task.scene, task.source.path, std::move(start),
              std::get<std::unique_ptr<Backend<R>>>(make_chosen(task.asked(), earlier))),
        totals(scene.engine()),
        particles(scene.engine(), scene.start().bodies,
                  {scene::kept_attributes(task.scene),
                   file_shift(task.scene.space.min, task.scene.space.end(), task.scene.space.spacing)},
                  task.particles()),
        fill(task.scene, regions_of(scene.start().world.colliders), task.options.folder),
        probes(columns_of(scene.probes().set()), task.options.folder / "probes"),
        ledger(scene.engine(), totals, task.options.folder / "ledger.csv"),
        record(scene.engine(), totals, ledger, task.options.folder, task.lock),
        strict(ledger),
        checkpoints(scene.engine(), totals, scene.probes().set(), task.hash, task.checkpoints(),
                    {task.scene.output.checkpoint_every, task.last}),
        progress(scene.engine(), totals) {
    scene.probes().add(
        [this](std::size_t p, double time, const std::vector<double>& row) { probes.append(p, time, row); });
    particles.use_frames(
        [this](const ParticleFrame& frame) { fill.append(world().time, world().frame, frame, poses_of(world())); });
    Engine<R>& engine = scene.engine();
    engine.add(totals), engine.add(particles), engine.add(ledger), engine.add(record);
    if (task.options.strict) engine.add(strict);
    engine.add(checkpoints), engine.add(progress);
  }
  const World<R>& world() const { return scene.engine().world(); }
};

/// One run of the simulate stage, from start or checkpoint to the last frame.
template <class R>
class SimulationRun {
 public:
  explicit SimulationRun(RunTask task) : task_(std::move(task)), threads_(task_.options.threads) {}

  SimulateResult go() {
    const SimulateOptions& options = task_.options;
    const LogFile log(options.folder / "log.txt");
    assemble_scene();
    // One that goes on has written part of it.
    if (std::string w = disk_shortage(disk_estimate(task_.scene, assembled_.particles()), options.folder);
        !options.resume && !w.empty())
      assembled_.warnings.push_back(std::move(w));
    for (const std::string& w : assembled_.warnings) warn("{}", w);
    for (const std::string& w : refused_later(task_.scene)) warn("a later stage will refuse this scene: {}", w);
    for (const std::string& n : assembled_.notes) info("{}", n);
    SimulateResult result;
    try {
      if (!options.resume || !restore()) {
        say_start();
        start();
      }
      result.first_frame = world().frame + (fresh_ ? 0 : 1);
      try {
        advance();
      } catch (const NumericalFailure& e) {
        if (world().settings.fixed_dt > 0) throw;
        again_at_half_cfl(e.what());
        advance();
      }
    } catch (const NumericalFailure& e) {
      if (watched_) watched_->record.end("failed", e.what());
      throw RunError(std::string(e.what()) + "; the frames and checkpoints before it are whole");
    } catch (const RunError& e) {
      if (watched_) watched_->record.end_failed(e.what());
      throw;
    }
    watched_->record.end("complete");
    result.frames_done = world().frame;
    return result;
  }

 private:
  const World<R>& world() const { return watched_->world(); }
  void assemble_scene() { assembled_ = assemble(task_.scene, task_.source.path); }
  void describe() { watched_->record.describe(task_.scene, task_.source, task_.hash, watched_->scene.start()); }

  /// A new start says what it does to a folder that is in use.
  void say_start() const {
    if (const std::size_t old = particle_files_in(task_.particles()).size(); old > 0)
      info("{}: starts again: replaces {} frame{} of an earlier run",
           task_.options.resume ? "no checkpoint to go on from" : "simulate", old, old == 1 ? "" : "s");
    else if (task_.options.resume)
      info("no checkpoint to go on from: starts at frame 1");
  }

  /// `particle_steps`: taken before, in vain.
  void start(std::uint64_t particle_steps = 0) {
    // What it refuses must leave an earlier run as it is.
    watched_ = std::make_unique<WatchedScene<R>>(task_, std::move(assembled_), task_.earlier);
    watched_->totals.go_on({}, particle_steps);
    watched_->record.begin(watched_->particles.content().shift);
    describe();
    watched_->scene.begin();
    with_kept_models(task_.scene);  // reads every file that a model names
    task_.lock->keep();
    for (const fs::path& old : checkpoints_in(task_.checkpoints())) fs::remove(old);
    for (const fs::path& old : particle_files_in(task_.particles())) fs::remove(old);
    if (const std::string w = too_many_stages(world()); !w.empty()) {
      warn("{}", w);
      watched_->record.add_warning(w);
    }
    watched_->probes.remove_earlier();
    watched_->probes.begin();
    watched_->fill.begin();
    watched_->scene.start().seeds = {};
    fresh_ = true;
    write_run_scene(task_.scene, task_.options.folder);
    watched_->scene.probes().sample(true);
    watched_->particles.on_frame();
    watched_->ledger.begin();
    watched_->record.on_frame();
  }

  /// Goes on from the newest checkpoint that can be read; false if there is none.
  bool restore() {
    const SimulateOptions& options = task_.options;
    std::optional<SavedRun<R>> saved = newest_checkpoint<R>(task_.checkpoints(), assembled_.world, task_.hash);
    if (!saved) return false;
    const BackendChoice before{saved->info.backend, saved->info.isa};
    watched_ = std::make_unique<WatchedScene<R>>(task_, std::move(assembled_), before);
    const BackendChoice now = choice_of(watched_->scene.engine().backend());
    if (now.backend != before.backend) saved->world.scatter_bounds = {};  // nobody kept them
    watched_->scene.go_on(std::move(saved->world), saved->info.probes);
    watched_->totals.go_on(saved->info.sums, saved->info.particle_steps);
    watched_->record.go_on(before);
    describe();
    if (!watched_->ledger.go_on())
      fail_input("{}: has no row of frame {}, from which {} goes on; without --resume the run starts again",
                 (options.folder / "ledger.csv").string(), world().frame, saved->file.filename().string());
    watched_->probes.go_on(world().time);
    watched_->fill.resume(world().time);
    watched_->scene.start().seeds = {};
    write_run_scene(task_.scene, options.folder);
    info("going on from {} at frame {}", saved->file.filename().string(), world().frame);
    if (now != before) {
      const std::string change = fmt::format("{} goes on with what {} computed: the same to rounding, not to the bit",
                                             now.text(), before.text());
      // A device is another than before without a word of the user.
      task_.asked() == BackendChoice{} ? warn("{}", change) : info("{}", change);
    }
    return true;
  }

  /// Once, a numerical failure goes back to the last good state and on from there in steps half as
  /// long.
  void again_at_half_cfl(const std::string& cause) {
    const double cfl = world().settings.cfl / 2;
    const std::uint64_t in_vain = watched_->totals.particle_steps();
    assemble_scene();
    assembled_.world.settings.cfl = cfl;
    if (!restore()) start(in_vain);
    watched_->scene.engine().world().settings.cfl = cfl;
    const std::string warning =
        fmt::format("{}; went on from frame {} with time.cfl {:.4g}", cause, world().frame, cfl);
    watched_->record.add_warning(warning);
    warn("{}", warning);
    watched_->record.save();
  }

  void advance() {
    const std::shared_ptr<Progress> progress = watched_->progress.show(task_.last);
    try {
      watched_->scene.engine().advance([&] { return world().frame >= task_.last; },
                                       [](const World<R>&) { return false; });
    } catch (const Interrupted&) {
      watched_->checkpoints.write();
      watched_->record.end("interrupted");
      throw Interrupted(fmt::format(
          "interrupted at frame {}; the state is saved: the same command with --resume goes on", world().frame));
    }
  }

  RunTask task_;
  ThreadLimit threads_;
  InitialState assembled_;  ///< until it is in an engine
  std::unique_ptr<WatchedScene<R>> watched_;
  bool fresh_ = false;
};

}  // namespace

SimulateResult simulate(const model::Scene& scene, const SceneSource& source, const SimulateOptions& options) {
  // Asked for once here, so that an unknown one is refused before anything is made.
  RunTask task{scene, source, options, nullptr};
  const auto backend = make_chosen(task.asked(), task.earlier);
  task.lock = options.lock ? options.lock : std::make_shared<RunLock>(options.folder);
  if (!options.resume && !options.overwrite) refuse_to_replace(options.folder);
  make_folder(task.particles());
  make_folder(task.checkpoints());
  return std::visit([&]<class R>(const std::unique_ptr<Backend<R>>&) { return SimulationRun<R>(task).go(); }, backend);
}

}  // namespace dreampm
