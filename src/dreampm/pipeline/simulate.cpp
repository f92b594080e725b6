#include "dreampm/pipeline/simulate.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/backend/registry.h"
#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/base/progress.h"
#include "dreampm/base/seconds_since.h"
#include "dreampm/io/ledger.h"
#include "dreampm/io/numbered.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/pipeline/fill_report.h"
#include "dreampm/pipeline/ledger_row.h"
#include "dreampm/pipeline/models.h"
#include "dreampm/pipeline/probes.h"
#include "dreampm/pipeline/run_folder.h"
#include "dreampm/pipeline/strict.h"
#include "dreampm/run/engine.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/problem.h"
#include "dreampm/setup/assemble.h"
#include "dreampm/setup/fixed_dt.h"
#include "dreampm/setup/start.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

/// Checkpoints in a folder by the step of their frame, newest first.
std::vector<fs::path> checkpoints_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".h5") files.push_back(entry.path());
  std::sort(files.begin(), files.end(), std::greater<>());
  return files;
}

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

/// One run of the simulate stage, from start or checkpoint to the last frame: watches an engine,
/// and writes what it sees.
template <class R>
class SimulationRun final : Observer<R> {
 public:
  SimulationRun(const SceneDescription& scene, const SceneSource& source, const SimulateOptions& options)
      : scene_(scene), source_(source), options_(options), folder_(options.folder), threads_(options.threads) {}

  SimulateResult go() {
    lock_ = options_.lock ? options_.lock : std::make_shared<RunLock>(folder_);
    if (!options_.resume && !options_.overwrite) refuse_to_replace(folder_);
    make_folder(folder_ / "particles");
    make_folder(folder_ / "checkpoint");
    const LogFile log(folder_ / "log.txt");
    hash_ = scene::scene_hash(scene_, scene::Part::simulation);
    last_ = options_.frames.value_or(scene_.time.frames);
    assembled_ = assemble(scene_, source_.path);
    // One that goes on has written part of it.
    if (std::string w = disk_shortage(disk_estimate(scene_, assembled_.particles()), folder_);
        !options_.resume && !w.empty())
      assembled_.warnings.push_back(std::move(w));
    for (const std::string& w : assembled_.warnings) warn("{}", w);
    for (const std::string& w : refused_later(scene_)) warn("a later stage will refuse this scene: {}", w);
    for (const std::string& n : assembled_.notes) info("{}", n);
    SimulateResult result;
    try {
      if (!options_.resume || !restore()) {
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
      finish("failed", e.what());
      throw RunError(std::string(e.what()) + "; the frames and checkpoints before it are whole");
    } catch (const RunError& e) {
      fail(e.what());
      throw;
    }
    finish("complete", std::nullopt);
    result.frames_done = world().frame;
    return result;
  }

 private:
  const World<R>& world() const { return std::as_const(*engine_).world(); }
  void make_engine(World<R> world, const std::string& isa) {
    engine_ = std::make_unique<Engine<R>>(std::move(world),
                                          std::get<std::unique_ptr<Backend<R>>>(make_backend(options_.backend, isa)));
    engine_->add(*this);
  }

  fs::path particle_file(int frame) const { return folder_ / "particles" / numbered("particles", frame, ".ply"); }

  /// A new start says what it does to a folder that is in use.
  void say_start() const {
    if (const std::size_t old = particle_files_in(folder_ / "particles").size(); old > 0)
      info("{}: starts again: replaces {} frame{} of an earlier run",
           options_.resume ? "no checkpoint to go on from" : "simulate", old, old == 1 ? "" : "s");
    else if (options_.resume)
      info("no checkpoint to go on from: starts at frame 1");
  }

  void start() {
    // What it refuses must leave an earlier run as it is.
    probes_ = std::make_unique<ProbeFiles<R>>(scene_, assembled_, source_.path, folder_ / "probes");
    make_engine(as_world<R>(assembled_.world), options_.isa);
    record_ = RunRecord::for_this_build();
    record_.shift = file_shift(scene_.space.min, scene_.space.max, scene_.space.spacing);
    describe();
    begin(*engine_, assembled_, scene_);
    check_fixed_dt(world(), assembled_.seeds, scene_.time, source_.path);
    with_kept_models(scene_);  // reads every file that a model names
    fill_ = std::make_unique<FillSeries>(scene_, regions_of(assembled_.world.colliders), folder_);
    lock_->keep();
    for (const fs::path& old : checkpoints_in(folder_ / "checkpoint")) fs::remove(old);
    for (const fs::path& old : particle_files_in(folder_ / "particles")) fs::remove(old);
    if (const std::string w = too_many_stages(world()); !w.empty()) {
      warn("{}", w);
      record_.warnings.push_back(w);
    }
    ledger_ = std::make_unique<LedgerWriter>(folder_ / "ledger.csv", ledger_kind(world()));
    last_row_.reset();
    probes_->begin();
    fill_->begin();
    assembled_.seeds = {};
    fresh_ = true;
    write_run_scene(scene_, folder_);
    sample_probes(true);
    write_frame();
  }

  /// Goes on from the newest checkpoint that can be read; false if there is none.
  bool restore() {
    for (const fs::path& file : checkpoints_in(folder_ / "checkpoint")) {
      ProbeMemories memories;
      World<R> saved = as_world<R>(assembled_.world);
      std::string isa;
      try {
        if (const std::string backend = checkpoint_info(file).backend; backend != options_.backend)
          fail_input("{}: was written by the backend {}; resume with --backend {}", file.string(), backend, backend);
        const CheckpointInfo info = load_checkpoint(file, hash_, saved);
        // Another instruction set would round differently and give another future.
        const bool forced = options_.isa != "auto" && options_.isa != info.isa;
        if (forced) fail_input("{}: was computed with {}; resume with that, or start again", file.string(), info.isa);
        isa = info.isa;
        sums_ = info.sums;
        particle_steps_ = info.particle_steps;
        memories = info.probes;
      } catch (const InputError& e) {
        if (file == checkpoints_in(folder_ / "checkpoint").back())
          fail_input("{}; no other checkpoint is left: without {} the run starts again", e.what(),
                     (folder_ / "checkpoint").string());
        warn("{}; trying the checkpoint before it", e.what());
        continue;
      }
      make_engine({}, isa);
      engine_->replace(std::move(saved), nullptr);
      record_ = RunRecord::load(folder_ / "run.json");
      describe();
      std::erase_if(record_.frames, [&](const FrameRecord& f) { return f.frame > world().frame; });
      ledger_ = std::make_unique<LedgerWriter>(folder_ / "ledger.csv", ledger_kind(world()), world().frame);
      const std::vector<LedgerRow> rows = read_ledger(folder_ / "ledger.csv").rows;
      if (rows.empty())
        fail_input("{}: has no row of frame {}, from which {} goes on; without --resume the run starts again",
                   (folder_ / "ledger.csv").string(), world().frame, file.filename().string());
      last_row_ = rows.back();
      probes_ = std::make_unique<ProbeFiles<R>>(scene_, assembled_, source_.path, folder_ / "probes");
      probes_->resume(memories, world().time);
      fill_ = std::make_unique<FillSeries>(scene_, regions_of(assembled_.world.colliders), folder_);
      fill_->resume(world().time);
      assembled_.seeds = {};
      write_run_scene(scene_, folder_);
      info("going on from {} at frame {}", file.filename().string(), world().frame);
      return true;
    }
    return false;
  }

  /// Once, a numerical failure goes back to the last good state and on from there in steps half as
  /// long.
  void again_at_half_cfl(const std::string& cause) {
    const double cfl = world().settings.cfl / 2;
    assembled_ = assemble(scene_, source_.path);
    assembled_.world.settings.cfl = cfl;
    sums_ = {};
    if (!restore()) start();
    engine_->world().settings.cfl = cfl;
    record_.warnings.push_back(
        fmt::format("{}; went on from frame {} with time.cfl {:.4g}", cause, world().frame, cfl));
    warn("{}", record_.warnings.back());
    save_record();
  }

  void describe() {
    record_.scene = source_.path;
    record_.variant = source_.variant;
    record_.scene_hash = hash_;
    record_.machine = this_machine(std::string(engine_->backend().isa()), thread_count());
    record_.particles = assembled_.particles();
    record_.spacing = scene_.space.spacing;
    record_.dx = world().dx;
    record_.backend = std::string(engine_->backend().name());
    for (const std::string& w : assembled_.warnings)
      if (std::find(record_.warnings.begin(), record_.warnings.end(), w) == record_.warnings.end())
        record_.warnings.push_back(w);
    record_.probes.clear();
    for (const scene::Probe& p : scene_.probes)
      record_.probes[p.name] = std::visit([]<class P>(const P&) { return std::string(P::type); }, p.form);
    record_.bodies.clear();
    for (const BodyRange& b : assembled_.bodies) record_.bodies.push_back({b.name, b.first_id, b.count});
    // Until it ends it may be killed at any time. What later stages made is of the run before.
    for (auto& [name, stage] : record_.stages) stage.status.reset(), stage.cause.reset();
    record_.end_stage("simulate", "interrupted");
    record_.stages["simulate"].settings_hash = scene::scene_hash(scene_, scene::Part::particles);
    earlier_seconds_ = record_.stages["simulate"].seconds.value_or(0);
    start_clock_ = Clock::now();
  }

  void advance() {
    Progress progress("simulate: frame", static_cast<std::size_t>(last_));
    progress.update(static_cast<std::size_t>(world().frame));
    progress_ = &progress;
    heaviest_ = 0;
    for (const auto& set : world().sets) heaviest_ = std::max(heaviest_, set.mass);
    sample_time_ = probes_->set().next();
    try {
      engine_->advance([&] { return world().frame >= last_; }, [](const World<R>&) { return false; });
    } catch (const Interrupted&) {
      checkpoint();
      finish("interrupted", std::nullopt);
      throw Interrupted(fmt::format(
          "interrupted at frame {}; the state is saved: the same command with --resume goes on", world().frame));
    }
  }

  double next_sample_time() const override { return sample_time_; }

  void on_step(const StepSums& step) override {
    sums_.add(step, heaviest_);
    particle_steps_ += world().particles();
    probes_->set().accumulate(step);
    if (step.frame_done || world().time >= sample_time_) sample_probes(step.frame_done);
    sample_time_ = probes_->set().next();
  }

  void on_frame() override {
    write_frame();
    const int frame = world().frame;
    if ((scene_.output.checkpoint_every > 0 && frame % scene_.output.checkpoint_every == 0) || frame == last_)
      checkpoint();
    progress_->update(static_cast<std::size_t>(frame), fmt::format("{} substeps", record_.frames.back().substeps));
  }

  void sample_probes(bool frame_done) {
    engine_->download(probes_->set().fields_due(world().time, frame_done));
    probes_->write(world(), engine_->motion(), frame_done);
  }

  void write_frame() {
    const Motion<R>& motion = engine_->motion();
    LedgerRow row = ledger_row(world(), engine_->backend(), motion, sums_, last_row_ ? &*last_row_ : nullptr);
    engine_->download(MatterFields::all);  // the hash is over all of it
    const ParticleFrame frame =
        particle_frame(world(), motion, assembled_.bodies, scene_.output.attributes, record_.shift);
    write_particles(particle_file(world().frame), frame);
    ledger_->append(row);
    if (const auto w = swollen_.look(world(), row)) warn_of_volume(*w);
    Hash64 hash;
    hash.add(state_hash(world()));
    record_.frames.push_back(
        {world().frame, world().time, sums_.substeps, hash.hex(), world().particles(), world().left});
    for (const Collider& c : world().colliders)
      // Paths and poses at the start are those of the scene.
      if (c.rigid || (!c.path && !(c.pose == Pose{}))) record_.frames.back().poses[c.name] = c.pose;
    fill_->append(world().time, world().frame, frame, record_.frames.back().poses);
    sums_ = {};
    save_record();
    if (options_.strict && last_row_)
      if (const auto breach = ledger_breach(*last_row_, row)) throw LedgerBreach(*breach);
    last_row_ = std::move(row);
  }

  /// Once a run, however often it was resumed.
  void warn_of_volume(const std::string& warning) {
    const auto known = [](const std::string& w) { return w.starts_with(swollen_warning_start); };
    if (std::any_of(record_.warnings.begin(), record_.warnings.end(), known)) return;
    warn("{}", warning);
    record_.warnings.push_back(warning);
  }

  void checkpoint() {
    engine_->download(MatterFields::all);
    const fs::path folder = folder_ / "checkpoint";
    save_checkpoint(folder / numbered("checkpoint", world().frame, ".h5"), world(),
                    {hash_, options_.backend, std::string(engine_->backend().isa()), sums_, particle_steps_,
                     probes_->set().memories()});
    const auto files = checkpoints_in(folder);
    for (std::size_t i = checkpoints_kept; i < files.size(); ++i) fs::remove(files[i]);
  }

  void save_record() {
    lock_->keep();
    StageRecord& stage = record_.stages["simulate"];
    stage.seconds = earlier_seconds_ + seconds_since(start_clock_);
    stage.frames = record_.frames.size();
    stage.particle_steps = particle_steps_;
    stage.peak_memory_bytes = peak_memory_bytes();
    record_.save(folder_ / "run.json");
  }

  void finish(const std::string& status, std::optional<std::string> cause) {
    record_.end_stage("simulate", status, std::move(cause));
    save_record();
  }

  /// As `finish`, where the disk may be what failed: the first cause is the one to report.
  void fail(const std::string& cause) {
    if (record_.scene.empty()) return;  // nothing was begun
    try {
      finish("failed", cause);
    } catch (const RunError& e) {
      warn("{}", e.what());
    }
  }

  const SceneDescription& scene_;
  const SceneSource& source_;
  const SimulateOptions& options_;
  fs::path folder_;
  std::shared_ptr<RunLock> lock_;
  ThreadLimit threads_;
  std::string hash_;
  int last_ = 1;
  InitialState assembled_;
  std::unique_ptr<Engine<R>> engine_;
  std::unique_ptr<LedgerWriter> ledger_;
  std::optional<LedgerRow> last_row_;
  SwollenWatch swollen_;
  std::unique_ptr<ProbeFiles<R>> probes_;
  std::unique_ptr<FillSeries> fill_;
  RunRecord record_;
  FrameSums sums_;
  std::uint64_t particle_steps_ = 0;
  Progress* progress_ = nullptr;  ///< while it advances
  double heaviest_ = 0;           ///< kg, of all particles
  double sample_time_ = 0;        ///< s, of the probe that is due next
  double earlier_seconds_ = 0;
  Clock::time_point start_clock_ = Clock::now();
  bool fresh_ = false;
};

}  // namespace

SimulateResult simulate(const SceneDescription& scene, const SceneSource& source, const SimulateOptions& options) {
  // Asked for once here, so that an unknown one is refused before anything is made.
  return std::visit(
      [&]<class R>(const std::unique_ptr<Backend<R>>&) { return SimulationRun<R>(scene, source, options).go(); },
      make_backend(options.backend, options.isa));
}

}  // namespace dreampm
