// Observers attached to a simulation, which write files of it.
#include "dreampm/observers.h"

#include <algorithm>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/run/frame_sums.h"
#include "dreampm/run/ledger_observer.h"
#include "dreampm/run/particle_observer.h"
#include "dreampm/run/probe_writer.h"
#include "dreampm/simulation/simulation_impl.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

template <class R>
class AttachedLedger final : public AttachedObserver {
 public:
  AttachedLedger(Engine<R>& engine, const fs::path& file, bool goes_on)
      : totals_(engine), ledger_(engine, totals_, file) {
    if (goes_on)
      ledger_.go_on();
    else
      ledger_.begin();
  }
  void on_step(const StepSums& step) override { totals_.on_step(step); }
  void on_frame() override { ledger_.on_frame(); }

 private:
  FrameTotals<R> totals_;
  LedgerObserver<R> ledger_;
};

template <class R>
class AttachedParticles final : public AttachedObserver {
 public:
  AttachedParticles(Engine<R>& engine, const Simulation::Impl& simulation, const ParticleFiles& files, bool goes_on)
      : particles_(engine, simulation.state.bodies, content_of(simulation, files), files.folder) {
    if (!goes_on) particles_.on_frame();
  }
  void on_frame() override { particles_.on_frame(); }

 private:
  static ParticleContent content_of(const Simulation::Impl& simulation, const ParticleFiles& files) {
    const model::Space& space = simulation.state.scene.model().space;
    return {files.attributes, file_shift(space.min, space.end(), space.spacing)};
  }
  ParticleObserver<R> particles_;
};

class AttachedProbes final : public AttachedObserver {
 public:
  AttachedProbes(const Simulation::Impl& simulation, const fs::path& folder, double time, bool goes_on)
      : writer_(columns_of(simulation), folder) {
    if (goes_on) {
      writer_.go_on(time);
      return;
    }
    writer_.begin();
    for (std::size_t p = 0; p < simulation.state.probes.size(); ++p) {
      const ProbeSeries& series = simulation.state.probes[p];
      for (std::size_t i = 0; i < series.rows.size(); ++i) writer_.append(p, series.time[i], series.rows[i]);
    }
  }
  void on_probe_row(std::size_t probe, double time, const std::vector<double>& row) override {
    writer_.append(probe, time, row);
  }

 private:
  static std::vector<ProbeColumns> columns_of(const Simulation::Impl& simulation) {
    std::vector<ProbeColumns> all;
    for (std::size_t p = 0; p < simulation.state.probes.size(); ++p)
      all.push_back({simulation.state.scene.model().probes[p].name, simulation.state.probes[p].columns});
    return all;
  }
  ProbeWriter writer_;
};

class AttachedCheckpoints final : public AttachedObserver {
 public:
  AttachedCheckpoints(const Simulation::Impl& simulation, CheckpointFiles files)
      : simulation_(simulation), files_(std::move(files)) {}
  void on_frame() override {
    const int frame = simulation_.with_engine([](auto& engine) { return engine.world().frame; });
    if (frame % files_.every != 0) return;
    simulation_.save(file_of(frame, ".yaml"));
    for (int old = frame - files_.every * files_.keep; files_.keep > 0 && old > 0; old -= files_.every) {
      if (!fs::remove(file_of(old, ".yaml"))) break;
      fs::remove(file_of(old, ".start.h5"));
    }
  }

 private:
  fs::path file_of(int frame, const char* extension) const {
    return files_.folder / numbered("checkpoint", frame, extension);
  }
  const Simulation::Impl& simulation_;
  CheckpointFiles files_;
};

void make_parent(const fs::path& file) {
  if (file.has_parent_path()) make_folder(file.parent_path());
}

void check_attributes(const std::vector<std::string>& attributes) {
  const auto& known = model::particle_attributes;
  for (const std::string& a : attributes)
    if (std::find(known.begin(), known.end(), a) == known.end())
      fail_unknown("attribute", a, {known.begin(), known.end()});
}

}  // namespace

void Simulation::Impl::attach(OpenObserver open) {
  AttachedFiles files{std::move(open), nullptr};
  files.observer = files.open(*this, false);
  attached.push_back(std::move(files));
}

void Simulation::Impl::reopen_attached() {
  for (AttachedFiles& files : attached) files.observer = files.open(*this, true);
}

void Simulation::Impl::take_attached(const Impl& from) {
  for (const AttachedFiles& files : from.attached) attached.push_back({files.open, files.open(*this, true)});
}

void attach(Simulation& simulation, const LedgerFile& ledger) {
  make_parent(ledger.file);
  SimulationAccess::impl(simulation).attach([ledger](Simulation::Impl& impl, bool goes_on) {
    return impl.with_engine([&]<class R>(Engine<R>& engine) -> std::unique_ptr<AttachedObserver> {
      return std::make_unique<AttachedLedger<R>>(engine, ledger.file, goes_on);
    });
  });
}

void attach(Simulation& simulation, const ParticleFiles& particles) {
  check_attributes(particles.attributes);
  make_folder(particles.folder);
  SimulationAccess::impl(simulation).attach([particles](Simulation::Impl& impl, bool goes_on) {
    return impl.with_engine([&]<class R>(Engine<R>& engine) -> std::unique_ptr<AttachedObserver> {
      return std::make_unique<AttachedParticles<R>>(engine, impl, particles, goes_on);
    });
  });
}

void attach(Simulation& simulation, const ProbeFiles& probes) {
  SimulationAccess::impl(simulation).attach([probes](Simulation::Impl& impl, bool goes_on) {
    const double time = impl.with_engine([](auto& engine) { return engine.world().time; });
    return std::make_unique<AttachedProbes>(impl, probes.folder, time, goes_on);
  });
}

void attach(Simulation& simulation, const CheckpointFiles& checkpoints) {
  if (checkpoints.every < 1) fail_input("CheckpointFiles: every is {} frames: must be 1 or more", checkpoints.every);
  if (checkpoints.keep < 0) fail_input("CheckpointFiles: keep is {}: must be 0 or more", checkpoints.keep);
  make_folder(checkpoints.folder);
  SimulationAccess::impl(simulation).attach([checkpoints](Simulation::Impl& impl, bool) {
    return std::make_unique<AttachedCheckpoints>(impl, checkpoints);
  });
}

}  // namespace dreampm
