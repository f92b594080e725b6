#include "dreampm/pipeline/checkpoint.h"

#include "dreampm/io/archive.h"
#include "dreampm/setup/world_archive.h"

namespace dreampm {
namespace {

constexpr const char* archive_format = "dreampm-checkpoint";
constexpr std::uint32_t archive_version = 6;

template <class R>
constexpr const char* precision_of = sizeof(R) == sizeof(float) ? "float" : "double";

std::vector<double> flat(const ImpulseSum& p) {
  return {p.impulse.x, p.impulse.y, p.impulse.z, p.angular.x, p.angular.y, p.angular.z, p.work};
}
ImpulseSum push_from(const std::vector<double>& v) { return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]}; }

void write_sums(ArchiveWriter& a, const FrameSums& s) {
  a.add("frame_sums/substeps", s.substeps);
  a.add("frame_sums/limiter", static_cast<std::uint8_t>(s.limiter));
  a.add("frame_sums/stages", static_cast<std::int32_t>(s.stages));
  a.add("frame_sums/dt", std::vector<double>{s.dt_min, s.dt_max});
  a.add("frame_sums/contact", flat(s.contact));
  a.add("frame_sums/body", flat(s.body));
  a.add("frame_sums/left", flat(s.left));
  a.add("frame_sums/more", std::vector<double>{s.left_mass, s.lost.viscous, s.lost.plastic, s.lost.relaxed, s.transfer,
                                               s.damping, s.rounding, s.jumps, s.grid_mass});
  if (s.entered.particles > 0) {
    const Entered& e = s.entered;
    a.add("frame_sums/entered",
          std::vector<double>{static_cast<double>(e.particles), e.mass, e.momentum.x, e.momentum.y, e.momentum.z,
                              e.angular.x, e.angular.y, e.angular.z, e.energy});
  }
  if (s.swollen) a.add("frame_sums/swollen", std::vector<double>{*s.swollen});
  if (s.projected) a.add("frame_sums/projected", std::vector<double>{*s.projected});
}
std::optional<double> optional_number(const ArchiveReader& a, const std::string& name) {
  return a.has(name) ? std::optional(a.read<double>(name, 1)[0]) : std::nullopt;
}
FrameSums read_sums(const ArchiveReader& a) {
  const auto dt = a.read<double>("frame_sums/dt", 2), more = a.read<double>("frame_sums/more", 9);
  Entered entered;
  if (a.has("frame_sums/entered")) {
    const auto e = a.read<double>("frame_sums/entered", 9);
    entered = {archived_count(a, "frame_sums/entered", e[0]), e[1], {e[2], e[3], e[4]}, {e[5], e[6], e[7]}, e[8]};
  }
  return {a.value<std::uint64_t>("frame_sums/substeps"),
          dt[0],
          dt[1],
          archived_limiter(a, "frame_sums/limiter"),
          a.has("frame_sums/stages") ? a.value<std::int32_t>("frame_sums/stages") : 0,
          push_from(a.read<double>("frame_sums/contact", 7)),
          push_from(a.read<double>("frame_sums/body", 7)),
          push_from(a.read<double>("frame_sums/left", 7)),
          entered,
          more[0],
          {0, 0, more[1], more[2], more[3]},
          more[4],
          more[5],
          more[6],
          more[7],
          more[8],
          optional_number(a, "frame_sums/swollen"),
          optional_number(a, "frame_sums/projected")};
}

void write_probes(ArchiveWriter& a, const ProbeMemories& probes) {
  for (const auto& [name, memory] : probes) {
    a.add("probe/" + name + "/identity", memory.identity);
    a.add("probe/" + name + "/memory", memory.values);
  }
}
ProbeMemories read_probes(const ArchiveReader& a) {
  constexpr std::string_view before = "probe/", after = "/identity";
  ProbeMemories probes;
  for (const std::string& key : a.keys())
    if (key.starts_with(before) && key.ends_with(after)) {
      const std::string name = key.substr(before.size(), key.size() - before.size() - after.size());
      probes[name] = {a.text(key), a.read<double>("probe/" + name + "/memory")};
    }
  return probes;
}

CheckpointInfo read_info(const ArchiveReader& a) {
  return {a.scene_hash(),
          a.text("backend"),
          a.text("isa"),
          read_sums(a),
          a.value<std::uint64_t>("particle_steps"),
          read_probes(a),
          a.has("precision") ? a.text("precision") : ""};
}

}  // namespace

template <class R>
void save_checkpoint(const std::filesystem::path& file, const World<R>& w, const CheckpointInfo& info) {
  write_archive(file, {archive_format, archive_version, info.scene_hash}, [&](ArchiveWriter& a) {
    a.add("backend", info.backend);
    a.add("isa", info.isa);
    a.add("precision", precision_of<R>);
    a.add("particle_steps", info.particle_steps);
    write_sums(a, info.sums);
    write_probes(a, info.probes);
    a.add("particles", static_cast<std::uint64_t>(w.particles()));
    write_world(a, w);
  });
}

CheckpointInfo checkpoint_info(const std::filesystem::path& file) {
  const ArchiveReader a(file, archive_format, archive_version);
  CheckpointInfo info = read_info(a);
  info.frame = a.value<std::int32_t>("frame");
  info.time = archived_time(a);
  if (a.has("particles")) info.particles = a.value<std::uint64_t>("particles");
  return info;
}

template <class R>
CheckpointInfo load_checkpoint(const std::filesystem::path& file, const std::string& scene_hash, World<R>& w) {
  const ArchiveReader a(file, archive_format, archive_version);
  a.expect_scene(scene_hash);
  const CheckpointInfo info = read_info(a);
  if (const std::string& there = info.precision; !there.empty() && there != precision_of<R>)
    throw OtherPrecision(
        fmt::format("{}: is in {}, as the backend {} computes, and not in {}: --backend {} goes on from it",
                    file.string(), there, info.backend, precision_of<R>, info.backend));
  read_world(a, w);
  return info;
}

template void save_checkpoint(const std::filesystem::path&, const World<float>&, const CheckpointInfo&);
template void save_checkpoint(const std::filesystem::path&, const World<double>&, const CheckpointInfo&);
template CheckpointInfo load_checkpoint(const std::filesystem::path&, const std::string&, World<float>&);
template CheckpointInfo load_checkpoint(const std::filesystem::path&, const std::string&, World<double>&);

}  // namespace dreampm
