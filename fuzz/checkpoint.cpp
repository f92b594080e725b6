// Checkpoints. An input is no file but a list of changes to the members of a right one, which is
// written and sealed anew: a file with other bytes than it was sealed with is refused before HDF5
// sees it (every tenth input is that).
#include "dreampm/pipeline/checkpoint.h"

#include <fuzzer/FuzzedDataProvider.h>

#include <map>
#include <variant>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/archive.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/world_fields.h"
#include "one_input.h"

using namespace dreampm;
namespace {

constexpr const char* format = "dreampm-checkpoint";

using Member = std::variant<std::string, std::vector<float>, std::vector<double>, std::vector<std::int32_t>,
                            std::vector<std::uint32_t>, std::vector<std::uint64_t>, std::vector<std::uint8_t>>;
using Members = std::map<std::string, Member>;

void fill(ParticleSet<float>& set, const char* name, const char* material, bool liquid, std::size_t columns) {
  set.name = name, set.material = material, set.liquid = liquid;
  set.mass = 0.5, set.rest_volume = 0.25, set.transfer = {1, 0.9, 0};
  set.id = {0, 1, 2};
  set.block_start = {0, 2, 3};
  for (auto* part : {&set.u, &set.own})
    for (auto& axis : *part) axis = {0.5, 1.5, 2.5};
  set.state.assign(columns, {1, 1.25, 1.5});
}

World<float> right_world() {
  World<float> w;
  w.dx = 0.125;
  w.set_domain({8, 8, 8});
  w.colliders = {{"post", nullptr, WallType::separate, 0, false}};
  w.emitters.resize(1), w.emitters[0].name = "tap";
  w.sinks.resize(1), w.sinks[0].name = "drain";
  fill(w.sets.emplace_back(), "water", "newtonian", true, state_columns<Newtonian>);
  fill(w.sets.emplace_back(), "jelly", "elastic", false, state_columns<Elastic>);
  w.particle_blocks = {{0, 0, 0}, {0, 0, 1}};
  std::vector<Vec3i> blocks;
  for (int n = 0; n < 12; ++n) blocks.push_back({n / 6, n / 3 % 2, n % 3});
  w.grid.blocks.assign(blocks);
  visit_nodes(w.grid, [&](const auto& field, auto& nodes) {
    if (field.needed(w)) nodes.assign(w.grid.blocks.size() * block_nodes, {1, 2, 3, 4});
  });
  return w;
}

std::filesystem::path path() { return fuzz::input_path(".h5"); }

std::uint32_t version_of(const std::filesystem::path& file) {
  for (std::uint32_t version = 0; version < 1000; ++version) try {
      ArchiveReader(file, format, version);
      return version;
    } catch (const InputError&) {
    }
  fuzz::fail("what was written cannot be opened");
}

/// The right file, by its members.
struct Right {
  std::uint32_t version;
  Members members;
  Right() : version(0) {
    CheckpointInfo info{"scene", "cpu", "avx2", {}, 7, {}};
    info.probes["level"] = {"height", {1, 2, 3}};
    info.sums.entered.particles = 1, info.sums.swollen = 0.5;
    save_checkpoint(path(), right_world(), info);
    version = version_of(path());
    const ArchiveReader in(path(), format, version);
    for (const std::string& key : in.keys()) members[key] = member(in, key);
    std::filesystem::remove(path());
  }

 private:
  template <class T>
  static bool take(const ArchiveReader& in, const std::string& key, Member& out) try {
    if constexpr (std::is_same_v<T, std::string>)
      out = in.text(key);
    else
      out = in.read<typename T::value_type>(key);
    return true;
  } catch (const InputError&) {
    return false;
  }
  template <class... Ts>
  static Member first_of(const ArchiveReader& in, const std::string& key, const std::variant<Ts...>&) {
    Member out;
    (take<Ts>(in, key, out) || ...);
    return out;
  }
  static Member member(const ArchiveReader& in, const std::string& key) { return first_of(in, key, Member{}); }
};

template <class T>
void change_value(FuzzedDataProvider& in, std::vector<T>& values) {
  if (values.empty()) return;
  T& value = values[in.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1)];
  if (in.ConsumeBool())
    value = static_cast<T>(in.ConsumeIntegralInRange<int>(0, 12));
  else if constexpr (std::is_floating_point_v<T>)
    value = in.ConsumeFloatingPoint<T>();
  else
    value = in.ConsumeIntegral<T>();
}

void change(FuzzedDataProvider& in, Members& members) {
  const auto at = std::next(members.begin(), in.ConsumeIntegralInRange<int>(0, static_cast<int>(members.size()) - 1));
  switch (in.ConsumeIntegralInRange<int>(0, 5)) {
    case 0:
      members.erase(at);
      return;
    case 1:
      at->second = std::vector<double>(in.ConsumeIntegralInRange<std::size_t>(0, 9), in.ConsumeFloatingPoint<double>());
      return;
    case 2:
      std::visit([&](auto& value) { value.resize(in.ConsumeIntegralInRange<std::size_t>(0, 40)); }, at->second);
      return;
    default:
      std::visit(
          [&](auto& value) {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
              value = in.ConsumeRandomLengthString(12);
            else
              change_value(in, value);
          },
          at->second);
  }
}

/// What a step does without a look.
void walk(const World<float>& world) {
  for (const ParticleSet<float>& set : world.sets)
    for (std::size_t b = 0; set.size() > 0 && b < world.particle_blocks.size(); ++b)
      for (std::uint32_t i = set.block_start.at(b); i < set.block_start.at(b + 1); ++i)
        for (const auto& axis : set.u)
          if (!(axis.at(i) > -1 && axis.at(i) < 5)) fuzz::fail("a particle is out of its block");
  for (const Vec3i& block : world.particle_blocks)
    if (world.grid.blocks.find(world.wrapped(block + Vec3i{1, 1, 1})) < 0) fuzz::fail("a block has no nodes");
  state_hash(world);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Right right;
  FuzzedDataProvider in(data, size);
  const bool damaged = in.ConsumeIntegralInRange<int>(0, 9) == 9;
  Members members = right.members;
  while (!damaged && in.remaining_bytes() > 0 && !members.empty()) change(in, members);
  const std::filesystem::path file = path();
  write_archive(file, {format, right.version, "scene"}, [&](ArchiveWriter& out) {
    for (const auto& [key, member] : members) std::visit([&](const auto& value) { out.add(key, value); }, member);
  });
  if (damaged) {
    std::string bytes = read_file(file);
    while (in.remaining_bytes() > 1)
      bytes[in.ConsumeIntegral<std::uint32_t>() % bytes.size()] ^= in.ConsumeIntegral<char>();
    write_bytes(file, bytes.data(), bytes.size());
  }
  const std::size_t written = std::filesystem::file_size(file);
  fuzz::read_one(written, 100, [&] { checkpoint_info(file); });
  fuzz::read_one(written, 100, [&] {
    World<float> world = right_world();
    load_checkpoint(file, "scene", world);
    walk(world);
  });
  std::filesystem::remove(file);
  return 0;
}
