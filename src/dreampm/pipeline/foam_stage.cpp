#include "dreampm/pipeline/foam_stage.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/pipeline/foam_limits.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/foam.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

std::string settings_hash_of(const RunFolder& run, const std::map<std::string, double>& found) {
  Hash64 hash;
  hash.add(std::string_view(scene::scene_hash(run.scene, scene::Part::foam, run.record.scene_hash)));
  for (const auto& [key, value] : found) hash.add(std::string_view(key)), hash.add(value);
  return hash.hex();
}

FoamRecord record_of(const FoamStep& step, int frame, const Vec3d& shift) {
  const FoamCounts& c = step.counts;
  FoamRecord r;
  r.frame = frame;
  r.crest = c.crest, r.trapped_air = c.trapped_air, r.vorticity = c.vorticity, r.beside_walls = c.beside_walls;
  r.aged = c.aged, r.at_walls = c.at_walls, r.outside = c.outside, r.thinned = c.thinned;
  if (c.born() > 0) r.place = c.place / static_cast<double>(c.born()) + shift;
  for (const FoamType t : step.particles.type)
    ++(t == FoamType::spray ? r.spray : t == FoamType::foam ? r.foam : t == FoamType::bubble ? r.bubbles : r.dust);
  return r;
}

void enter(RunFolder& run, const FoamRecord& r) {
  auto& list = run.record.stages["foam"].foam;
  std::erase_if(list, [&](const FoamRecord& o) { return o.frame == r.frame; });
  list.insert(
      std::upper_bound(list.begin(), list.end(), r, [](const auto& a, const auto& b) { return a.frame < b.frame; }), r);
}

FoamCounts& operator+=(FoamCounts& a, const FoamCounts& b) {
  a.crest += b.crest, a.trapped_air += b.trapped_air, a.vorticity += b.vorticity, a.beside_walls += b.beside_walls;
  a.place += b.place, a.aged += b.aged, a.at_walls += b.at_walls, a.outside += b.outside, a.thinned += b.thinned;
  return a;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}
void append(FoamParticles& to, const FoamParticles& from) {
  append(to.position, from.position), append(to.velocity, from.velocity), append(to.type, from.type);
  append(to.age, from.age), append(to.life, from.life), append(to.radius, from.radius), append(to.id, from.id);
  to.next_id = from.next_id;
}

FoamParticles of_kind(const FoamParticles& all, bool dust) {
  FoamParticles out;
  out.next_id = all.next_id;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if ((all.type[i] == FoamType::dust) != dust) continue;
    out.position.push_back(all.position[i]), out.velocity.push_back(all.velocity[i]), out.type.push_back(all.type[i]);
    out.age.push_back(all.age[i]), out.life.push_back(all.life[i]), out.radius.push_back(all.radius[i]);
    out.id.push_back(all.id[i]);
  }
  return out;
}

/// Makes one frame after the other.
class FoamMaker {
 public:
  FoamMaker(RunFolder& run, const FoamObstacles& obstacles, std::vector<FoamingKind> kinds)
      : run_(run), obstacles_(obstacles), kinds_(std::move(kinds)) {}

  FoamStep make(int frame) const {
    FoamStep all;
    if (frame == run_.record.frames.front().frame) return all;  // nothing has moved yet
    const FrameRecord &now = run_.frame_record(frame), &before = run_.frame_record(frame - 1);
    const FoamFrame was = read_foam(foam_file(run_, frame - 1));
    const std::vector<foam::Obstacle> obstacles = obstacles_.at(now, before);
    all.particles.next_id = was.particles.next_id;
    for (const FoamingKind& kind : kinds_) {
      const FoamingMatter from = foaming_matter(run_, frame - 1, kind.materials),
                          to = foaming_matter(run_, frame, kind.materials);
      FoamParticles own = of_kind(was.particles, kind.rules.dust);
      own.next_id = all.particles.next_id;
      FoamRules rules = kind.rules;
      rules.most -= std::min(rules.most, all.particles.size());
      const FoamStep step = advance_foam(own, from.view(), to.view(), obstacles,
                                         static_cast<float>(now.time - before.time), frame, rules);
      append(all.particles, step.particles);
      all.counts += step.counts;
    }
    return all;
  }

 private:
  const RunFolder& run_;
  const FoamObstacles& obstacles_;
  std::vector<FoamingKind> kinds_;
};

/// What it takes at most, said before the work.
void say_memory(const RunFolder& run, const std::vector<FoamingKind>& kinds) {
  std::uint64_t particles = 0;
  for (const FrameRecord& f : run.record.frames) particles = std::max(particles, f.particles);
  const double bytes = static_cast<double>(estimate_foam(*run.scene.foam, particles).memory_bytes);
  for (const FoamingKind& k : kinds)
    info("foam: {}scale {:.3g} m, {:.3g} per m^3 and s at the limits, radius {:.3g} mm", k.rules.dust ? "dust: " : "",
         k.rules.scale, k.rules.rate, 1e3f * k.rules.radius);
  info("foam: takes at most {:.0f} MB, with foam.most at {}", bytes / 1e6, run.scene.foam->most);
}

/// Each frame is made of the one before.
void check_predecessor(const RunFolder& run, const std::vector<int>& frames) {
  if (frames.empty() || frames.front() == run.record.frames.front().frame) return;
  if (const std::string why = no_foam(run, {frames.front() - 1}); !why.empty())
    fail_input("{}: frame {} is made of the foam of frame {}. {}", run.folder.string(), frames.front(),
               frames.front() - 1, why);
}

}  // namespace

fs::path foam_file(const RunFolder& run, int frame) { return run.folder / "foam" / numbered("foam", frame, ".ply"); }

std::function<Identity(int frame)> foam_identity(const RunFolder& run) {
  if (!run.scene.foam) return [](int) { return Identity{}; };
  const auto stage = run.record.stages.find("foam");
  const std::string settings =
      settings_hash_of(run, stage != run.record.stages.end() ? stage->second.found : std::map<std::string, double>{});
  // A frame hangs on all before it.
  std::map<int, std::string> states;
  Hash64 state;
  state.add(std::string_view(run.record.scene_hash));
  for (const FrameRecord& f : run.record.frames) {
    state.add(std::string_view(f.state_hash));
    states[f.frame] = state.hex();
  }
  return [settings, states](int frame) -> Identity {
    const auto at = states.find(frame);
    return {{"simulation until then", at == states.end() ? "" : at->second}, {"foam settings", settings}};
  };
}

std::string no_foam(const RunFolder& run, const std::vector<int>& frames) {
  if (!run.scene.foam) return {};
  const FrameTable table(run.folder / "foam" / "frames.csv");
  const auto identity = foam_identity(run);
  for (const int f : frames) {
    std::string why = table.why_redo(f, identity(f));
    if (why.empty() && !fs::exists(foam_file(run, f))) why = "new";
    if (!why.empty())
      return fmt::format("{}: the foam of frame {} is {}; dreampm foam {} makes it", run.folder.string(), f,
                         why == "new" ? "missing" : "not up to date: " + why, run.folder.string());
  }
  return {};
}

StageResult foam_stage(RunFolder& run, const FrameRange& frames_asked) {
  if (!run.scene.foam || run.frames().empty()) return {};
  if (!run.lock) run.lock = std::make_shared<RunLock>(run.folder);
  const FoamObstacles obstacles(run.scene, run.record.shift);
  std::map<std::string, double> found;
  std::vector<FoamingKind> kinds = foaming_kinds(run, obstacles, found);
  run.record.stages["foam"].found = found;
  StageWork work;
  work.name = "foam";
  work.settings_hash = settings_hash_of(run, found);
  work.frames = run.chosen(frames_asked.first, frames_asked.last);
  work.all_frames = frames_asked.first == 0 && frames_asked.last == 0;
  work.identity = foam_identity(run);
  work.products = [&](int f) { return std::vector<fs::path>{foam_file(run, f)}; };
  check_predecessor(run, work.frames);
  std::erase_if(run.record.stages["foam"].foam, [&](const FoamRecord& r) {
    const auto frames = run.frames();
    return std::find(frames.begin(), frames.end(), r.frame) == frames.end();
  });
  bool said = false;
  const FoamMaker maker(run, obstacles, kinds);
  work.make = [&](int f) {
    if (!said) say_memory(run, kinds), said = true;
    const FoamStep step = maker.make(f);
    if (step.counts.thinned > 0)
      warn("foam: frame {}: {} were not emitted: foam.most is {}", f, step.counts.thinned, run.scene.foam->most);
    write_foam(foam_file(run, f), step.particles, run.record.shift);
    enter(run, record_of(step, f, run.record.shift));
  };
  const StageResult result = run_stage(run, work);
  if (result.made == 0) return result;
  const LogFile log(run.folder / "log.txt");
  for (const std::string& line : foam_lines(run.record)) info("foam: {}", line);
  return result;
}

}  // namespace dreampm
