#include "dreampm/pipeline/checkpoint.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "dreampm/base/error.h"
#include "dreampm/io/archive.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

constexpr const char* archive_format = "dreampm-checkpoint";
constexpr std::uint32_t archive_version = 6;

std::vector<std::int32_t> flat(const std::vector<Vec3i>& blocks) {
  std::vector<std::int32_t> v;
  v.reserve(blocks.size() * 3);
  for (const Vec3i& b : blocks) v.insert(v.end(), {b.x, b.y, b.z});
  return v;
}
std::vector<Vec3i> blocks_from(const std::vector<std::int32_t>& v) {
  std::vector<Vec3i> blocks(v.size() / 3);
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
  return blocks;
}

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
  if (s.swollen) a.add("frame_sums/swollen", std::vector<double>{*s.swollen});
}
FrameSums read_sums(const ArchiveReader& a) {
  const auto dt = a.read<double>("frame_sums/dt", 2), more = a.read<double>("frame_sums/more", 9);
  return {a.value<std::uint64_t>("frame_sums/substeps"),
          dt[0],
          dt[1],
          static_cast<Limiter>(a.value<std::uint8_t>("frame_sums/limiter")),
          a.has("frame_sums/stages") ? a.value<std::int32_t>("frame_sums/stages") : 0,
          push_from(a.read<double>("frame_sums/contact", 7)),
          push_from(a.read<double>("frame_sums/body", 7)),
          push_from(a.read<double>("frame_sums/left", 7)),
          more[0],
          {0, 0, more[1], more[2], more[3]},
          more[4],
          more[5],
          more[6],
          more[7],
          more[8],
          a.has("frame_sums/swollen") ? std::optional(a.read<double>("frame_sums/swollen", 1)[0]) : std::nullopt};
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
  return {a.scene_hash(), a.text("backend"), a.text("isa"), read_sums(a), a.value<std::uint64_t>("particle_steps"),
          read_probes(a)};
}

}  // namespace

void FrameSums::add(const StepSums& step, double heaviest) {
  ++substeps;
  if (step.dt < dt_min) dt_min = step.dt, limiter = step.limiter;
  dt_max = std::max(dt_max, step.dt);
  stages = std::max(stages, step.stages);
  contact += step.grid.contact();
  body += step.body;
  left += step.left;
  left_mass += step.left_mass;
  damping -= step.grid.damping.work;
  lost += step.pass.energy;
  transfer += step.transfer;
  rounding += step.rounding;
  // The sums over steps are rounded too, in double: a reference run sees it.
  rounding += 0.5 * std::numeric_limits<double>::epsilon() *
              (length(contact.impulse) + length(body.impulse) + length(left.impulse));
  // None is pushed further than it moved.
  if (step.pass.pushed > 0)
    jumps += heaviest * static_cast<double>(step.pass.pushed) * step.grid.max_speed * step.grid.max_speed * step.dt;
  grid_mass = step.grid.mass;
  if (step.swollen) swollen = step.swollen;
}

template <class R>
void save_checkpoint(const std::filesystem::path& file, const World<R>& w, const CheckpointInfo& info) {
  write_archive(file, {archive_format, archive_version, info.scene_hash}, [&](ArchiveWriter& a) {
    a.add("backend", info.backend);
    a.add("isa", info.isa);
    a.add("particle_steps", info.particle_steps);
    write_sums(a, info.sums);
    write_probes(a, info.probes);
    a.add("step", w.step);
    a.add("frame", static_cast<std::int32_t>(w.frame));
    a.add("clock", std::vector<double>{w.time, w.dt_next, w.drift, w.wave_speed, w.viscosity, w.settings.cfl});
    a.add("dt_limiter", static_cast<std::uint8_t>(w.dt_limiter));
    a.add("viscous_stages", static_cast<std::int32_t>(w.viscous_stages));
    a.add("left", w.left);
    a.add("particles", static_cast<std::uint64_t>(w.particles()));
    a.add("particle_blocks", flat(w.particle_blocks));
    a.add("grid/blocks", flat(w.grid.blocks.all()));
    const auto numbers = [](const auto& nodes) {
      constexpr std::size_t each = sizeof(nodes[0]) / sizeof(R);
      return std::span<const R>(reinterpret_cast<const R*>(nodes.data()), nodes.size() * each);
    };
    a.add("grid/nodes", numbers(w.grid.nodes));
    a.add("grid/solids", numbers(w.grid.solids));
    a.add("grid/mixture", numbers(w.grid.mixture));
    if (w.keeps_velocities(0) || w.keeps_velocities(1)) a.add("keeping", std::vector<double>{w.keeping});
    for (std::size_t f = 0; f < 2; ++f)
      if (w.keeps_velocities(f)) a.add("grid/before" + std::to_string(f), numbers(w.grid.velocity_old[f]));
    for (std::size_t f = 0; f < 2; ++f)
      if (!w.grid.stress[f].empty()) a.add("grid/stress" + std::to_string(f), numbers(w.grid.stress[f]));
    for (const auto& set : w.sets) {
      const std::string at = "set/" + set.name + "/";
      a.add(at + "id", set.id);
      a.add(at + "block_start", set.block_start);
      for (std::size_t i = 0; i < 3; ++i) a.add(at + "u" + std::to_string(i), numbers(set.u[i]));
      if (set.transfer.keeps_velocity())
        for (std::size_t i = 0; i < 3; ++i) a.add(at + "own" + std::to_string(i), numbers(set.own[i]));
      for (std::size_t i = 0; i < set.state.size(); ++i) a.add(at + "state" + std::to_string(i), numbers(set.state[i]));
    }
  });
}

CheckpointInfo checkpoint_info(const std::filesystem::path& file) {
  const ArchiveReader a(file, archive_format, archive_version);
  CheckpointInfo info = read_info(a);
  info.frame = a.value<std::int32_t>("frame");
  info.time = a.read<double>("clock").at(0);
  if (a.has("particles")) info.particles = a.value<std::uint64_t>("particles");
  return info;
}

template <class R>
CheckpointInfo load_checkpoint(const std::filesystem::path& file, const std::string& scene_hash, World<R>& w) {
  const ArchiveReader a(file, archive_format, archive_version);
  a.expect_scene(scene_hash);
  const CheckpointInfo info = read_info(a);
  w.step = a.value<std::uint64_t>("step");
  w.frame = a.value<std::int32_t>("frame");
  const auto clock = a.read<double>("clock", 6);
  w.time = clock[0], w.dt_next = clock[1], w.drift = clock[2], w.wave_speed = clock[3], w.viscosity = clock[4];
  w.settings.cfl = clock[5];
  w.dt_limiter = static_cast<Limiter>(a.value<std::uint8_t>("dt_limiter"));
  if (a.has("viscous_stages")) w.viscous_stages = a.value<std::int32_t>("viscous_stages");
  w.left = a.value<std::uint64_t>("left");
  w.particle_blocks = blocks_from(a.read<std::int32_t>("particle_blocks"));
  w.grid.blocks.assign(blocks_from(a.read<std::int32_t>("grid/blocks")));
  const std::size_t nodes = w.grid.blocks.size() * block_nodes;
  const auto read = [&](const std::string& name, auto& target, std::size_t size) {
    using Target = typename std::remove_reference_t<decltype(target)>::value_type;
    const auto numbers = a.read<R>(name, size * (sizeof(Target) / sizeof(R)));
    target.resize(size);
    if (size > 0) std::memcpy(static_cast<void*>(target.data()), numbers.data(), numbers.size() * sizeof(R));
  };
  const auto fill = [&](const std::string& name, Nodes<R>& field, bool used) { read(name, field, used ? nodes : 0); };
  fill("grid/nodes", w.grid.nodes, true);
  fill("grid/solids", w.grid.solids, w.needs_solid_field());
  fill("grid/mixture", w.grid.mixture, w.needs_mixture());
  if (w.keeps_velocities(0) || w.keeps_velocities(1)) w.keeping = a.read<double>("keeping", 1)[0];
  for (std::size_t f = 0; f < 2; ++f)
    if (w.keeps_velocities(f)) fill("grid/before" + std::to_string(f), w.grid.velocity_old[f], true);
  for (std::size_t f = 0; f < 2; ++f) {
    const std::string name = "grid/stress" + std::to_string(f);
    w.grid.stress[f].clear();
    if (a.has(name)) fill(name, w.grid.stress[f], true);
  }
  for (auto& set : w.sets) {
    const std::string at = "set/" + set.name + "/";
    set.id = a.read<std::uint32_t>(at + "id");
    set.block_start = a.read<std::uint32_t>(at + "block_start");
    for (std::size_t i = 0; i < 3; ++i) read(at + "u" + std::to_string(i), set.u[i], set.size());
    if (set.transfer.keeps_velocity())
      for (std::size_t i = 0; i < 3; ++i) read(at + "own" + std::to_string(i), set.own[i], set.size());
    Materials::with(set.material, [&]<class M>() { set.state.resize(set.id.empty() ? 0 : state_columns<M>); });
    for (std::size_t i = 0; i < set.state.size(); ++i) read(at + "state" + std::to_string(i), set.state[i], set.size());
  }
  return info;
}

template void save_checkpoint(const std::filesystem::path&, const World<float>&, const CheckpointInfo&);
template void save_checkpoint(const std::filesystem::path&, const World<double>&, const CheckpointInfo&);
template CheckpointInfo load_checkpoint(const std::filesystem::path&, const std::string&, World<float>&);
template CheckpointInfo load_checkpoint(const std::filesystem::path&, const std::string&, World<double>&);

}  // namespace dreampm
