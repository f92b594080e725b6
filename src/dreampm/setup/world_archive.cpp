#include "dreampm/setup/world_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "dreampm/geometry/whole.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/world_check.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {
namespace {

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

/// Numbers that share one array, in its order; others have arrays of their own, by their names.
constexpr std::array<std::string_view, 6> clock_names = {"time", "dt_next", "drift", "wave_speed", "viscosity", "cfl"};
/// The name's number among them; clock_names.size() if it is not there.
constexpr std::size_t clock_index(std::string_view name) {
  return static_cast<std::size_t>(std::find(clock_names.begin(), clock_names.end(), name) - clock_names.begin());
}

/// True if a file has to have the array of that member: the others are in it only where they are
/// not empty.
template <class F, class Owner>
bool required(const F& field, const Owner& owner) {
  return !F::use.sparse || (F::use.carried && field.needed(owner));
}

std::uint64_t stored(std::uint64_t v) { return v; }
std::int32_t stored(int v) { return v; }
std::uint32_t stored(std::uint32_t v) { return v; }
double stored(double v) { return v; }
std::uint8_t stored(Limiter v) { return static_cast<std::uint8_t>(v); }

/// x, y, z, and the quaternion w, x, y, z.
std::vector<double> numbers_of(const Pose& pose) {
  const auto& [p, q] = pose;
  return {p.x, p.y, p.z, q.w, q.x, q.y, q.z};
}
Pose pose_from(const std::vector<double>& n) { return {{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}}; }

template <class R>
class WorldWriter {
 public:
  WorldWriter(ArchiveWriter& to, const World<R>& world) : to_(to), world_(world) {}
  void write() {
    std::vector<double> clock(clock_names.size());
    const World<R> initial;
    visit_fields(world_, initial, [&]<class F, class T>(const F& field, const T& value, const T& unset) {
      if constexpr (F::use.saved) {
        const std::string name(field.name);
        if constexpr (std::is_same_v<T, double>)
          if (const std::size_t at = clock_index(name); at < clock.size()) {
            clock[at] = value;
            return;
          }
        if constexpr (F::use.sparse)
          if (value == unset) return;
        put(name, value);
      }
    });
    to_.add("clock", clock);
  }

 private:
  template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(const std::string& name, T number) {
    to_.add(name, stored(number));
  }
  void put(const std::string& name, const std::vector<Vec3i>& blocks) { to_.add(name, flat(blocks)); }
  void put(const std::string& name, const BlockList& blocks) { to_.add(name, flat(blocks.all())); }
  void put(const std::string& name, const std::vector<std::uint32_t>& numbers) { to_.add(name, numbers); }
  template <std::size_t count>
  void put(const std::string& name, const std::array<double, count>& numbers) {
    to_.add(name, std::vector<double>(numbers.begin(), numbers.end()));
  }
  void put(const std::string& name, const LargeVector<R>& numbers) { to_.add(name, std::span<const R>(numbers)); }
  void put(const std::string& name, const Nodes<R>& nodes) {
    constexpr std::size_t each = sizeof(Node<R>) / sizeof(R);
    to_.add(name, std::span<const R>(reinterpret_cast<const R*>(nodes.data()), nodes.size() * each));
  }
  /// The columns of a member.
  template <class Columns>
    requires std::is_same_v<typename Columns::value_type, LargeVector<R>>
  void put(const std::string& name, const Columns& columns) {
    for (std::size_t i = 0; i < columns.size(); ++i) put(name + std::to_string(i), columns[i]);
  }
  void put(const std::string& name, const std::vector<ParticleSet<R>>& sets) {
    for (const ParticleSet<R>& set : sets) members(name + "/" + set.name + "/", set, set);
  }
  /// Writes the poses of colliders that have moved: those of the others are in the scene.
  void put(const std::string& name, const std::vector<Collider>& colliders) {
    for (const Collider& c : colliders) {
      if (!c.moves()) continue;
      const auto& [velocity, spin, center] = c.twist;
      to_.add(name + "/" + c.name + "/pose", numbers_of(c.pose));
      to_.add(name + "/" + c.name + "/twist", std::vector<double>{velocity.x, velocity.y, velocity.z, spin.x, spin.y,
                                                                  spin.z, center.x, center.y, center.z});
      to_.add(name + "/" + c.name + "/surface_pose", numbers_of(c.surface_pose));
      if (c.slack != Collider::settle_distance) to_.add(name + "/" + c.name + "/slack", std::vector<double>{c.slack});
      if (c.changing) to_.add(name + "/" + c.name + "/time", std::vector<double>{c.time, c.surface_time});
    }
  }
  void put(const std::string& name, const std::vector<Emitter>& emitters) {
    for (const Emitter& e : emitters)
      to_.add(name + "/" + e.name, std::vector<double>{static_cast<double>(e.born), e.dry ? 1.0 : 0.0});
  }
  void put(const std::string& name, const std::vector<Sink>& sinks) {
    for (const Sink& s : sinks) {
      const auto& [p, l] = std::tie(s.momentum, s.angular);
      to_.add(name + "/" + s.name, std::vector<double>{static_cast<double>(s.taken), p.x, p.y, p.z, l.x, l.y, l.z});
    }
  }
  void put(const std::string& name, const std::vector<Arrival>& arrivals) {
    std::vector<double> numbers;
    for (const Arrival& a : arrivals)
      numbers.insert(numbers.end(), {static_cast<double>(a.first_id), static_cast<double>(a.count),
                                     static_cast<double>(a.emitter), a.time});
    to_.add(name, numbers);
  }
  void put(const std::string& name, const GridFields<R>& grid) { members(name + "/", grid, world_); }

  template <class Parts, class Owner>
  void members(const std::string& at, const Parts& parts, const Owner& owner) {
    visit_fields(parts, [&]<class F>(const F& field, const auto& value) {
      if constexpr (F::use.saved) {
        const auto empty = [&] {
          if constexpr (F::use.sparse && requires { value[0].empty(); })
            return value[0].empty();
          else if constexpr (F::use.sparse)
            return value.empty();
          else
            return false;
        };
        if (required(field, owner) || !empty()) put(at + std::string(field.name), value);
      }
    });
  }

  ArchiveWriter& to_;
  const World<R>& world_;
};

template <class R>
class WorldReader {
 public:
  WorldReader(const ArchiveReader& from, World<R>& world) : from_(from), world_(world) {}
  void read() {
    read_fields();
    if (const auto fault = find_fault(world_)) from_.refuse(fault->member, fault->why);
  }

 private:
  void read_fields() {
    const auto clock = from_.read<double>("clock", clock_names.size());
    const World<R> initial;
    visit_fields(world_, initial, [&]<class F, class T>(const F& field, T& value, const T& unset) {
      if constexpr (F::use.saved) {
        const std::string name(field.name);
        if constexpr (std::is_same_v<T, double>)
          if (const std::size_t at = clock_index(name); at < clock.size()) {
            value = clock[at];
            return;
          }
        if constexpr (F::use.sparse)
          if (!from_.has(name)) {
            value = unset;
            return;
          }
        get(name, value);
      }
    });
  }
  template <class T>
    requires std::is_arithmetic_v<T>
  void get(const std::string& name, T& number) {
    number = static_cast<T>(from_.value<decltype(stored(number))>(name));
  }
  /// Reads the whole array.
  void get(const std::string& name, LargeVector<R>& numbers) {
    const auto stored_ones = from_.read<R>(name);
    numbers.assign(stored_ones.begin(), stored_ones.end());
  }
  template <std::size_t count>
  void get(const std::string& name, std::array<double, count>& numbers) {
    const auto stored_ones = from_.read<double>(name, count);
    std::copy(stored_ones.begin(), stored_ones.end(), numbers.begin());
  }
  void get(const std::string& name, Limiter& limiter) { limiter = archived_limiter(from_, name); }
  void get(const std::string& name, std::vector<Vec3i>& blocks) {
    const auto numbers = from_.read<std::int32_t>(name);
    if (numbers.size() % 3 != 0) from_.refuse(name, fmt::format("{} numbers are no places", numbers.size()));
    blocks = blocks_from(numbers);
  }
  void get(const std::string& name, std::vector<ParticleSet<R>>& sets) {
    for (ParticleSet<R>& set : sets) {
      const std::string at = name + "/" + set.name + "/";
      visit_fields(set, [&]<class F, class T>(const F& field, T& value) {
        if constexpr (F::use.saved) {
          const std::string its = at + std::string(field.name);
          if constexpr (std::is_same_v<T, std::vector<std::uint32_t>>) {
            value = from_.read<std::uint32_t>(its);
          } else {
            if (!required(field, set)) return;
            if constexpr (std::is_same_v<T, std::vector<LargeVector<R>>>)
              Materials::with(set.material, [&]<class M>() { value.resize(set.size() == 0 ? 0 : state_columns<M>); });
            for (std::size_t i = 0; i < value.size(); ++i) fill(its + std::to_string(i), value[i], set.size());
          }
        }
      });
    }
  }
  void get(const std::string& name, std::vector<Collider>& colliders) {
    for (Collider& c : colliders) {
      const std::string its = name + "/" + c.name;
      c.pose = c.surface_pose = {}, c.twist = {};
      if (!from_.has(its + "/pose")) continue;
      c.pose = pose_from(from_.read<double>(its + "/pose", 7));
      c.surface_pose = pose_from(from_.read<double>(its + "/surface_pose", 7));
      const auto t = from_.read<double>(its + "/twist", 9);
      // The slack of a collider that a program added: a scene has none.
      c.slack = from_.has(its + "/slack") ? from_.read<double>(its + "/slack", 1).front() : Collider::settle_distance;
      if (c.changing) {
        const auto times = from_.read<double>(its + "/time", 2);
        c.time = times[0], c.surface_time = times[1];
        c.take_shape();
      }
      c.twist = {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}};
    }
  }
  void get(const std::string& name, std::vector<Emitter>& emitters) {
    for (Emitter& e : emitters) {
      const auto counts = from_.read<double>(name + "/" + e.name, 2);
      e.born = archived_count(from_, name + "/" + e.name, counts[0]), e.dry = counts[1] != 0;
    }
  }
  void get(const std::string& name, std::vector<Sink>& sinks) {
    for (Sink& s : sinks) {
      const auto sums = from_.read<double>(name + "/" + s.name, 7);
      s.taken = archived_count(from_, name + "/" + s.name, sums[0]);
      s.momentum = {sums[1], sums[2], sums[3]}, s.angular = {sums[4], sums[5], sums[6]};
    }
  }
  void get(const std::string& name, std::vector<Arrival>& arrivals) {
    const auto numbers = from_.read<double>(name);
    if (numbers.size() % 4 != 0) from_.refuse(name, fmt::format("{} numbers are no batches of matter", numbers.size()));
    arrivals.clear();
    const auto id = [&](double n) {
      if (const auto whole_one = whole<std::uint32_t>(n)) return *whole_one;
      from_.refuse(name, fmt::format("{} is no number of particles", n));
    };
    for (std::size_t i = 0; i < numbers.size(); i += 4) {
      arrivals.push_back({id(numbers[i]), id(numbers[i + 1]), id(numbers[i + 2]), numbers[i + 3]});
      if (arrivals.back().emitter >= world_.emitters.size())
        from_.refuse(name, fmt::format("there is no emitter of number {}", arrivals.back().emitter));
    }
    if (std::adjacent_find(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
          return b.first_id < std::uint64_t{a.first_id} + a.count;
        }) != arrivals.end())
      from_.refuse(name, "batches of matter share particles, or do not rise by their ids");
  }
  void get(const std::string& name, GridFields<R>& grid) {
    std::vector<Vec3i> blocks;
    get(name + "/blocks", blocks);
    if (const auto why = find_fault(blocks)) from_.refuse(name + "/blocks", *why);
    grid.blocks.assign(std::move(blocks));
    const std::size_t nodes = grid.blocks.size() * block_nodes;
    visit_nodes(grid, [&]<class F>(const F& field, Nodes<R>& value) {
      const std::string its = name + "/" + std::string(field.name);
      const bool there = F::use.sparse && from_.has(its);
      if (there || required(field, world_))
        fill(its, value, there || field.needed(world_) ? nodes : 0);
      else
        value.clear();
    });
  }
  template <class T>
  void fill(const std::string& name, LargeVector<T>& target, std::size_t size) {
    const auto numbers = from_.read<R>(name, size * (sizeof(T) / sizeof(R)));
    target.resize(size);
    if (size > 0) std::memcpy(static_cast<void*>(target.data()), numbers.data(), numbers.size() * sizeof(R));
  }

  const ArchiveReader& from_;
  World<R>& world_;
};

}  // namespace

double archived_time(const ArchiveReader& from) { return from.read<double>("clock", clock_names.size()).front(); }

Limiter archived_limiter(const ArchiveReader& from, const std::string& name) {
  const auto number = from.value<std::uint8_t>(name);
  if (number > stored(Limiter::user)) from.refuse(name, fmt::format("there is no limit of number {}", number));
  return static_cast<Limiter>(number);
}

std::uint64_t archived_count(const ArchiveReader& from, const std::string& name, double number) {
  const std::optional<std::uint64_t> n = whole<std::uint64_t>(number);
  if (!n) from.refuse(name, fmt::format("{} is no count", number));
  return *n;
}

template <class R>
void write_world(ArchiveWriter& to, const World<R>& world) {
  WorldWriter<R>(to, world).write();
}
template <class R>
void read_world(const ArchiveReader& from, World<R>& world) {
  WorldReader<R>(from, world).read();
}

template void write_world(ArchiveWriter&, const World<float>&);
template void write_world(ArchiveWriter&, const World<double>&);
template void read_world(const ArchiveReader&, World<float>&);
template void read_world(const ArchiveReader&, World<double>&);

}  // namespace dreampm
