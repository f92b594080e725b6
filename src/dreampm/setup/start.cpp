#include "dreampm/setup/start.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/io/archive.h"
#include "dreampm/setup/world_archive.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t start_version = 1;

/// Spacing, cells, and how many of them: what particles lie by.
template <class R>
std::vector<double> space_of(const World<R>& world) {
  const Vec3d cells = static_cast<Vec3d>(world.high - world.low);
  return {world.sets.empty() ? 0 : world.sets.front().spacing(), world.dx, cells.x, cells.y, cells.z};
}

std::string names_of(const std::vector<std::pair<std::string, std::size_t>>& particles) {
  std::string names;
  for (const auto& [name, count] : particles) names += (names.empty() ? "" : ", ") + name;
  return names;
}

template <class R>
void write_motion(ArchiveWriter& a, const std::string& name, const typename Motion<R>::Set& motion) {
  const auto numbers = [](const auto& list, std::size_t each) {
    return std::span<const R>(reinterpret_cast<const R*>(list.data()), list.size() * each);
  };
  a.add("motion/" + name + "/velocity", numbers(motion.velocity, 3));
  a.add("motion/" + name + "/gradient", numbers(motion.gradient, 9));
  a.add("motion/" + name + "/energy", std::span<const R>(motion.energy));
  a.add("motion/" + name + "/volume_ratio", std::span<const R>(motion.volume_ratio));
}

template <class R>
typename Motion<R>::Set read_motion(const ArchiveReader& a, const std::string& name, std::size_t size) {
  typename Motion<R>::Set motion;
  const auto fill = [&](const char* column, auto& list, std::size_t each) {
    const std::vector<R> numbers = a.read<R>("motion/" + name + "/" + column, size * each);
    list.resize(size);
    std::copy(numbers.begin(), numbers.end(), reinterpret_cast<R*>(list.data()));
  };
  fill("velocity", motion.velocity, 3), fill("gradient", motion.gradient, 9);
  fill("energy", motion.energy, 1), fill("volume_ratio", motion.volume_ratio, 1);
  return motion;
}

template <class R>
void check_fits(const ArchiveReader& a, const World<R>& world, const std::string& file) {
  const auto then = a.read<double>("space", 5), now = space_of(world);
  if (then != now)
    fail_input(
        "start: {} is of particles {:.6g} m apart in {} x {} x {} cells; the scene has {:.6g} m and {} x {} x {}", file,
        then[0], then[2], then[3], then[4], now[0], now[2], now[3], now[4]);
  const StartInfo info = start_info(file);
  for (const ParticleSet<R>& set : world.sets)
    if (std::none_of(info.particles.begin(), info.particles.end(), [&](const auto& p) { return p.first == set.name; }))
      fail_input("start: {} has no material {}; it has {}", file, set.name, names_of(info.particles));
  if (info.particles.size() != world.sets.size())
    fail_input("start: {} has the materials {}; the scene has {} of them", file, names_of(info.particles),
               world.sets.size());
  for (const ParticleSet<R>& set : world.sets)
    if (const bool carried = a.has("set/" + set.name + "/gradient0");
        info.count(set.name) > 0 && carried != set.carries_motion)
      fail_input("start: {} was made by time.solver: {}, and the scene has {}: write that, or leave start out", file,
                 carried ? "projection" : "explicit", set.carries_motion ? "projection" : "explicit");
  if (const std::string precision = a.text("precision"); precision != (sizeof(R) == 4 ? "float" : "double"))
    fail_input("start: {} is in {}, as --backend {} has it", file, precision,
               precision == "float" ? "cpu" : "reference");
}

}  // namespace

std::size_t StartInfo::count(std::string_view material) const {
  const auto at = std::find_if(particles.begin(), particles.end(), [&](const auto& p) { return p.first == material; });
  return at == particles.end() ? 0 : at->second;
}

StartInfo start_info(const fs::path& file) {
  const ArchiveReader a(file, start_format, start_version);
  StartInfo info;
  info.frame = a.value<std::int32_t>("frame"), info.time = archived_time(a);
  for (const std::string& key : a.keys())
    if (key.starts_with("particles/"))
      info.particles.emplace_back(key.substr(std::string_view("particles/").size()), a.value<std::uint64_t>(key));
  const auto p = a.read<double>("momentum", 3);
  info.momentum = {p[0], p[1], p[2]};
  info.expected = {a.value<double>("expected/speed"), a.text("expected/sources")};
  return info;
}

int first_frame(const model::Scene& scene) { return scene.start.empty() ? 1 : start_info(scene.start).frame; }

template <class R>
void write_start(const fs::path& file, const World<R>& world, const Motion<R>& motion, const ExpectedSpeed& expected) {
  write_archive(file, {start_format, start_version, ""}, [&](ArchiveWriter& a) {
    a.add("precision", sizeof(R) == 4 ? "float" : "double");
    a.add("space", space_of(world));
    a.add("hash", state_hash(world));
    a.add("expected/speed", expected.speed);
    a.add("expected/sources", expected.sources);
    Vec3d momentum{};
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      const ParticleSet<R>& set = world.sets[s];
      a.add("particles/" + set.name, static_cast<std::uint64_t>(set.size()));
      write_motion<R>(a, set.name, motion.sets[s]);
      for (const Vec3<R>& v : motion.sets[s].velocity) momentum += static_cast<Vec3d>(v) * set.mass;
    }
    a.add("momentum", std::vector<double>{momentum.x, momentum.y, momentum.z});
    write_world(a, world);
  });
}

template <class R>
bool read_start(const fs::path& file, int frames, World<R>& world, Motion<R>& motion) {
  const ArchiveReader a(file, start_format, start_version);
  check_fits(a, world, file.string());
  const double cfl = world.settings.cfl;
  read_world(a, world);
  world.settings.cfl = cfl;
  if (world.frame > frames)
    fail_input("start: {} is at frame {}, t = {:.6g} s, and time.frames is {}: frames count from t = 0", file.string(),
               world.frame, world.time, frames);
  motion.sets.clear();
  for (const ParticleSet<R>& set : world.sets) motion.sets.push_back(read_motion<R>(a, set.name, set.size()));
  return state_hash(world) == a.value<std::uint64_t>("hash");
}

template void write_start(const fs::path&, const World<float>&, const Motion<float>&, const ExpectedSpeed&);
template void write_start(const fs::path&, const World<double>&, const Motion<double>&, const ExpectedSpeed&);
template bool read_start(const fs::path&, int, World<float>&, Motion<float>&);
template bool read_start(const fs::path&, int, World<double>&, Motion<double>&);

}  // namespace dreampm
