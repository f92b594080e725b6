#include "dreampm/pictures/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/base/narrow.h"
#include "dreampm/base/order.h"
#include "dreampm/physics/materials.h"
#include "dreampm/pictures/sources.h"
#include "dreampm/state/cell_pressure.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// Pressure -tr(sigma)/3 [Pa] of a particle's present state; by the projection that of the cells
/// there.
template <class R>
void add_pressure(const World<R>& world, const Motion<R>& motion, std::size_t s, std::vector<float>& out) {
  const ParticleSetView particles(world, s);
  if (world.settings.solver == SolverKind::projection && world.sets[s].liquid) {
    const CellPressure<R> pressure(world);
    particles.for_each([&](std::size_t, const Vec3d& x) { out.push_back(static_cast<float>(pressure.at(x))); });
    return;
  }
  Materials::with(world.sets[s].material, [&]<class M>() {
    const auto law = M::template Law<R>::from(world.sets[s].values);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const StressResponse<R> r = law.respond(particles.template state<M>(p));
      out.push_back(static_cast<float>(-(r.tau.xx + r.tau.yy + r.tau.zz) / (R(3) * motion.sets[s].volume_ratio[p])));
    }
  });
}

/// A state column by name, or its value in a material that has none.
template <class R>
void add_state(const World<R>& world, std::size_t s, std::string_view name, float otherwise, std::vector<float>& out) {
  const ParticleSetView particles(world, s);
  const auto c = find_column(world.sets[s].material, name);
  for (std::size_t p = 0; p < particles.size(); ++p)
    out.push_back(c ? static_cast<float>(particles.column(*c)[p]) : otherwise);
}

constexpr std::array<std::uint8_t, 4> white{255, 255, 255, 255};

/// Of a column of a matrix, as `f_12`.
bool is_on_diagonal(std::string_view column) { return column[column.size() - 2] == column.back(); }

/// What follows from where particles came from: age [s], source and color, of those that are
/// wanted.
template <class R, class Wanted>
void add_sources(const World<R>& world, const std::vector<BodyRange>& bodies, const Wanted& wanted, ParticleFrame& f) {
  const bool age = wanted("age"), source = wanted("source"), color = wanted("color");
  if (!age && !source && !color) return;
  const Sources sources(world, bodies);
  std::vector<std::array<std::uint8_t, 4>> colors;
  for (const auto& own : sources.colors()) {
    std::array<std::uint8_t, 4>& bytes = colors.emplace_back(white);
    for (int c = 0; own && c < 3; ++c)
      bytes[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround((*own)[c] * 255));
  }
  for (const std::int32_t id : f.id) {
    const Sources::Source from = sources.of(static_cast<std::uint32_t>(id));
    if (age) f.columns["age"].push_back(static_cast<float>(world.time - from.since));
    if (source) f.columns["source"].push_back(static_cast<float>(from.number));
    if (color) f.color.push_back(from.number < 0 ? white : colors[static_cast<std::size_t>(from.number)]);
  }
  if (source) f.source_names = sources.names();
}

template <class T>
void reorder(std::vector<T>& v, const std::vector<std::uint32_t>& order) {
  if (v.empty()) return;
  std::vector<T> next(v.size());
  for (std::size_t i = 0; i < order.size(); ++i) next[i] = v[order[i]];
  v.swap(next);
}

}  // namespace

Vec3d file_shift(const Vec3d& min, const Vec3d& max, double spacing) {
  constexpr double exact = 1 << 14;  // spacings up to which a float is right to 2^-10 of one
  Vec3d shift;
  for (int a = 0; a < 3; ++a) {
    const double far = std::max(std::abs(min[a]), std::abs(max[a])), size = max[a] - min[a];
    if (far > exact * spacing && size < far) shift[a] = min[a];
  }
  return shift;
}

std::vector<std::string> columns_of(std::string_view attribute) {
  const std::string_view matrix = attribute == "f" ? "f" : attribute == "velocity_gradient" ? "c" : "";
  if (matrix.empty()) return {std::string(attribute)};
  std::vector<std::string> names;
  for (int c = 0; c < 9; ++c) names.push_back(fmt::format("{}_{}{}", matrix, c / 3, c % 3));
  return names;
}

std::vector<std::string> other_columns(std::string_view material) {
  std::vector<std::string> names;
  Materials::with(material, [&]<class M>() {
    for (const std::string_view name : M::template State<float>::names)
      if (name != "jp" && !name.starts_with("f_")) names.emplace_back(name);
  });
  return names;
}

template <class R>
void add_column(const World<R>& world, const Motion<R>& motion, std::size_t s, std::string_view column,
                std::vector<float>& out) {
  const auto& set = world.sets[s];
  const auto& m = motion.sets[s];
  if (column == "j") {
    for (const R j : m.volume_ratio) out.push_back(static_cast<float>(j));
  } else if (column == "density") {
    for (const R j : m.volume_ratio)
      out.push_back(static_cast<float>(set.mass / (set.rest_volume * static_cast<double>(j))));
  } else if (column == "pressure") {
    add_pressure(world, motion, s, out);
  } else if (column.starts_with("c_")) {
    for (const Mat3<R>& c : m.gradient) out.push_back(static_cast<float>(c(column[2] - '0', column[3] - '0')));
  } else {
    const bool is_one = column == "jp" || (column.starts_with("f_") && is_on_diagonal(column));
    add_state(world, s, column, is_one ? 1.0f : 0.0f, out);
  }
}

template <class R>
ParticleFrame particle_frame(const World<R>& world, const Motion<R>& motion, const std::vector<BodyRange>& bodies,
                             const std::vector<std::string>& attributes, const Vec3d& shift) {
  const auto wanted = [&](std::string_view a) {
    return std::find(attributes.begin(), attributes.end(), a) != attributes.end();
  };
  ParticleFrame f;
  f.shift = shift;
  const std::size_t n = world.particles();
  f.position.reserve(n);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const auto& m = motion.sets[s];
    f.material_names.push_back(world.sets[s].name);
    const auto material = narrow<std::uint8_t>(s, "materials");
    const ParticleSetView particles(world, s);
    particles.for_each([&](std::size_t p, const Vec3d& x) {
      f.position.push_back(static_cast<Vec3f>(x - shift));
      f.id.push_back(narrow<std::int32_t>(particles.id(p), "particles"));
      f.material.push_back(material);
      f.velocity.push_back(static_cast<Vec3f>(m.velocity[p]));
    });
    for (const char* attribute : {"j", "density", "pressure", "jp", "f"})
      if (wanted(attribute))
        for (const std::string& column : columns_of(attribute)) add_column(world, motion, s, column, f.columns[column]);
  }
  add_sources(world, bodies, wanted, f);
  const std::vector<std::uint32_t> order = order_of<std::int32_t>(f.id);
  reorder(f.position, order), reorder(f.velocity, order), reorder(f.id, order), reorder(f.material, order),
      reorder(f.color, order);
  for (auto& [name, column] : f.columns) reorder(column, order);
  return f;
}

template void add_column(const World<float>&, const Motion<float>&, std::size_t, std::string_view, std::vector<float>&);
template void add_column(const World<double>&, const Motion<double>&, std::size_t, std::string_view,
                         std::vector<float>&);
template ParticleFrame particle_frame(const World<float>&, const Motion<float>&, const std::vector<BodyRange>&,
                                      const std::vector<std::string>&, const Vec3d&);
template ParticleFrame particle_frame(const World<double>&, const Motion<double>&, const std::vector<BodyRange>&,
                                      const std::vector<std::string>&, const Vec3d&);

}  // namespace dreampm
