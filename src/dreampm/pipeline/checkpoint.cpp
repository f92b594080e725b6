#include "dreampm/pipeline/checkpoint.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/io/archive.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

constexpr const char* archive_format = "dreampm-checkpoint";
constexpr std::uint32_t archive_version = 1;

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

CheckpointInfo read_info(const ArchiveReader& a) {
  CheckpointInfo info{a.scene_hash(), a.text("backend"), a.text("isa"), {}, a.value<std::uint64_t>("particle_steps")};
  const auto sums = a.read<double>("frame_sums", 5);
  info.sums = {a.value<std::uint64_t>("frame_substeps"),
               sums[0],
               sums[1],
               static_cast<Limiter>(a.value<std::uint8_t>("frame_limiter")),
               {sums[2], sums[3], sums[4]}};
  return info;
}

}  // namespace

void FrameSums::add(double dt, Limiter l, const Vec3d& impulse) {
  ++substeps;
  if (dt < dt_min) dt_min = dt, limiter = l;
  dt_max = std::max(dt_max, dt);
  wall_impulse += impulse;
}

template <class R>
void save_checkpoint(const std::filesystem::path& file, const World<R>& w, const CheckpointInfo& info) {
  write_archive(file, {archive_format, archive_version, info.scene_hash}, [&](ArchiveWriter& a) {
    a.add("backend", info.backend);
    a.add("isa", info.isa);
    a.add("particle_steps", info.particle_steps);
    const FrameSums& s = info.sums;
    a.add("frame_sums", std::vector<double>{s.dt_min, s.dt_max, s.wall_impulse.x, s.wall_impulse.y, s.wall_impulse.z});
    a.add("frame_substeps", s.substeps);
    a.add("frame_limiter", static_cast<std::uint8_t>(s.limiter));
    a.add("step", w.step);
    a.add("frame", static_cast<std::int32_t>(w.frame));
    a.add("clock", std::vector<double>{w.time, w.dt_next, w.drift, w.wave_speed, w.viscosity});
    a.add("dt_limiter", static_cast<std::uint8_t>(w.dt_limiter));
    a.add("left", w.left);
    a.add("particle_blocks", flat(w.particle_blocks));
    a.add("grid/blocks", flat(w.grid.blocks.all()));
    a.add("grid/nodes",
          std::span<const R>(w.grid.nodes.empty() ? nullptr : &w.grid.nodes[0].x, w.grid.nodes.size() * 4));
    a.add("grid/liquid",
          std::span<const R>(w.grid.liquid.empty() ? nullptr : &w.grid.liquid[0].mass, w.grid.liquid.size() * 2));
    for (const auto& set : w.sets) {
      const std::string at = "set/" + set.name + "/";
      a.add(at + "id", set.id);
      a.add(at + "block_start", set.block_start);
      for (std::size_t i = 0; i < 3; ++i) a.add(at + "u" + std::to_string(i), set.u[i]);
      for (std::size_t i = 0; i < set.state.size(); ++i) a.add(at + "state" + std::to_string(i), set.state[i]);
    }
  });
}

CheckpointInfo checkpoint_info(const std::filesystem::path& file) {
  return read_info(ArchiveReader(file, archive_format, archive_version));
}

template <class R>
CheckpointInfo load_checkpoint(const std::filesystem::path& file, const std::string& scene_hash, World<R>& w) {
  const ArchiveReader a(file, archive_format, archive_version);
  a.expect_scene(scene_hash);
  const CheckpointInfo info = read_info(a);
  w.step = a.value<std::uint64_t>("step");
  w.frame = a.value<std::int32_t>("frame");
  const auto clock = a.read<double>("clock", 5);
  w.time = clock[0], w.dt_next = clock[1], w.drift = clock[2], w.wave_speed = clock[3], w.viscosity = clock[4];
  w.dt_limiter = static_cast<Limiter>(a.value<std::uint8_t>("dt_limiter"));
  w.left = a.value<std::uint64_t>("left");
  w.particle_blocks = blocks_from(a.read<std::int32_t>("particle_blocks"));
  w.grid.blocks.assign(blocks_from(a.read<std::int32_t>("grid/blocks")));
  const std::size_t nodes = w.grid.blocks.size() * block_nodes;
  const auto node = a.read<R>("grid/nodes", nodes * 4);
  w.grid.nodes.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i)
    w.grid.nodes[i] = {node[4 * i], node[4 * i + 1], node[4 * i + 2], node[4 * i + 3]};
  const auto liquid = a.read<R>("grid/liquid", w.needs_liquid_channel() ? nodes * 2 : 0);
  w.grid.liquid.resize(liquid.size() / 2);
  for (std::size_t i = 0; i < w.grid.liquid.size(); ++i) w.grid.liquid[i] = {liquid[2 * i], liquid[2 * i + 1]};
  for (auto& set : w.sets) {
    const std::string at = "set/" + set.name + "/";
    set.id = a.read<std::uint32_t>(at + "id");
    set.block_start = a.read<std::uint32_t>(at + "block_start");
    for (std::size_t i = 0; i < 3; ++i) set.u[i] = a.read<R>(at + "u" + std::to_string(i), set.size());
    Materials::with(set.material, [&]<class M>() { set.state.resize(set.id.empty() ? 0 : state_columns<M>); });
    for (std::size_t i = 0; i < set.state.size(); ++i)
      set.state[i] = a.read<R>(at + "state" + std::to_string(i), set.size());
  }
  return info;
}

template void save_checkpoint(const std::filesystem::path&, const World<float>&, const CheckpointInfo&);
template void save_checkpoint(const std::filesystem::path&, const World<double>&, const CheckpointInfo&);
template CheckpointInfo load_checkpoint(const std::filesystem::path&, const std::string&, World<float>&);
template CheckpointInfo load_checkpoint(const std::filesystem::path&, const std::string&, World<double>&);

}  // namespace dreampm
