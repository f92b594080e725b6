#include "dreampm/pipeline/foam_limits.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/progress.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/foam.h"

namespace dreampm {
namespace fs = std::filesystem;

FoamingMatter foaming_matter(const RunFolder& run, int number, const std::vector<int>& materials) {
  const fs::path file = run.particles(number);
  if (!read_ply_header(file).find("vertex")->find("vx"))
    fail_input("{}: has no velocities (vx, vy, vz), of which foam is made", file.string());
  const ParticleFrame frame = read_particles(file);
  std::vector<std::uint8_t> wanted;
  for (const std::string& name : frame.material_names)
    wanted.push_back(std::any_of(materials.begin(), materials.end(),
                                 [&](int m) { return run.scene.materials[std::size_t(m)].name == name; }));
  const auto j = frame.columns.find("j");
  FoamingMatter out;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (frame.material[i] >= wanted.size() || !wanted[frame.material[i]]) continue;
    out.position.push_back(frame.position[i]), out.velocity.push_back(frame.velocity[i]);
    out.id.push_back(frame.id[i]);
    if (j != frame.columns.end()) out.volume_ratio.push_back(j->second[i]);
  }
  return out;
}

FoamObstacles::FoamObstacles(const model::Scene& scene, const Vec3d& shift) : shift_(shift) {
  const Meshes meshes(Meshes::Say::keep);
  for (const model::Collider& c : scene.colliders)
    if (!c.pin) solids_.emplace_back(c, scene.space, meshes);
}

std::vector<foam::Obstacle> FoamObstacles::at(const FrameRecord& frame, const FrameRecord& before) const {
  std::vector<foam::Obstacle> all;
  for (const SolidInTime& s : solids_) {
    foam::Obstacle o{.shape = s.region_at(frame.time), .pose = s.pose_in(frame), .before = s.pose_in(before)};
    o.shift = shift_;
    if (!(o.pose == o.before)) o.dt = frame.time - before.time;
    o.bounds = o.shape->bounds();
    all.push_back(std::move(o));
  }
  return all;
}

namespace {

/// Maxima of frames by what they were found of, as foam/maxima.csv keeps them.
class MaximaTable {
 public:
  explicit MaximaTable(fs::path file) : file_(std::move(file)) {
    if (!fs::exists(file_)) return;
    std::istringstream in(read_file(file_));
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::istringstream row(line);
      std::string key;
      FoamMaxima m;
      char comma = 0;
      // A row that cannot be read is found again.
      if (std::getline(row, key, ',') &&
          row >> m.moving >> comma >> m.speed >> comma >> m.trapped_air >> comma >> m.crest >> comma >> m.vorticity)
        rows_[key] = m;
    }
  }
  const FoamMaxima* find(const std::string& key) const {
    const auto row = rows_.find(key);
    return row == rows_.end() ? nullptr : &row->second;
  }
  void enter(const std::string& key, const FoamMaxima& m) { used_[key] = m, rows_[key] = m; }
  /// What was entered or asked for; the rest is of another run.
  void keep(const std::string& key) { used_[key] = rows_.at(key); }
  void save() const {
    std::string text = "of,moving,speed,trapped_air,crest,vorticity\n";
    for (const auto& [key, m] : used_)
      text += fmt::format("{},{},{},{},{},{}\n", key, m.moving, m.speed, m.trapped_air, m.crest, m.vorticity);
    replace_file_text(file_, text);
  }

 private:
  fs::path file_;
  std::map<std::string, FoamMaxima> rows_, used_;
};

/// The volume of the matter at rest, in the frame that has most particles [m^3].
double most_volume(const RunFolder& run, const std::vector<int>& frames, const std::vector<int>& materials) {
  int most = frames.front();
  for (const int f : frames)
    if (run.frame_record(f).particles > run.frame_record(most).particles) most = f;
  return static_cast<double>(foaming_matter(run, most, materials).position.size()) *
         std::pow(run.scene.space.spacing, 3);
}

/// Raised where the measures of foam/fields.h change: what was found by others is found again.
constexpr int measures_version = 2;

std::string key_of(const RunFolder& run, int frame, const FoamingKind& kind) {
  Hash64 hash;
  hash.add(std::string_view(run.record.scene_hash)), hash.add(std::string_view(run.state_hash(frame)));
  for (const int m : kind.materials) hash.add(m);
  hash.add(kind.rules.scale), hash.add(measures_version);
  return hash.hex();
}

void note(std::map<std::string, double>& found, const FoamRules& r) {
  const std::string kind = r.dust ? "dust." : "";
  const auto limits = [&](const char* name, const FoamCause& c) {
    found[fmt::format("{}{}.from", kind, name)] = static_cast<double>(c.from);
    found[fmt::format("{}{}.to", kind, name)] = static_cast<double>(c.to);
  };
  found[kind + "scale"] = static_cast<double>(r.scale), found[kind + "radius"] = static_cast<double>(r.radius);
  found[kind + "rate"] = static_cast<double>(r.rate);
  limits("speed", r.speed), limits("trapped_air", r.trapped_air), limits("crest", r.crest);
  limits("vorticity", r.vorticity);
}

}  // namespace

std::vector<FoamingKind> foaming_kinds(RunFolder& run, const FoamObstacles& obstacles,
                                       std::map<std::string, double>& found) {
  std::vector<FoamingKind> kinds;
  const std::vector<int> frames = run.frames();
  if (frames.empty()) return kinds;
  for (const bool dust : {false, true}) {
    FoamingKind kind;
    for (const int m : scene::foaming_materials(run.scene))
      if ((scene::foam_kind(run.scene.materials[std::size_t(m)]) == scene::FoamKind::dust) == dust)
        kind.materials.push_back(m);
    if (kind.materials.empty()) continue;
    kind.rules =
        foam_rules(*run.scene.foam, run.scene, dust, run.record.shift, most_volume(run, frames, kind.materials));
    kinds.push_back(std::move(kind));
  }
  const fs::path folder = run.folder / "foam";
  make_folder(folder);
  MaximaTable table(folder / "maxima.csv");
  const bool given = limits_given(*run.scene.foam);
  std::size_t done = 0, made = 0;
  Progress progress("foam: looks at frame", given ? 0 : kinds.size() * frames.size());
  for (FoamingKind& kind : kinds) {
    std::vector<FoamMaxima> maxima;
    if (!given)
      for (const int f : frames) {
        if (interrupted()) throw Interrupted("foam: interrupted while it looked at the frames");
        const std::string key = key_of(run, f, kind);
        if (table.find(key)) {
          table.keep(key);
        } else {
          progress.update(done);
          const FoamingMatter matter = foaming_matter(run, f, kind.materials);
          table.enter(key,
                      foam_maxima(matter.view(), obstacles.at(run.frame_record(f), run.frame_record(f)), kind.rules));
          if (++made % 20 == 0) table.save();
        }
        maxima.push_back(*table.find(key));
        ++done;
      }
    set_limits(kind.rules, *run.scene.foam, found_limits(maxima, kind.rules));
    note(found, kind.rules);
  }
  if (made > 0) table.save(), progress.update(done);
  return kinds;
}

}  // namespace dreampm
