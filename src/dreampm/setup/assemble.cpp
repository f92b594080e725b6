#include "dreampm/setup/assemble.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/io/run_record.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/physics/param.h"
#include "dreampm/physics/transfers.h"
#include "dreampm/setup/body_checks.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/filling.h"
#include "dreampm/setup/inflow.h"
#include "dreampm/setup/notes.h"
#include "dreampm/setup/place.h"
#include "dreampm/setup/projection_checks.h"
#include "dreampm/setup/rigid.h"
#include "dreampm/setup/start.h"
#include "dreampm/setup/thin_colliders.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {
namespace {

/// Columns twice while they are sorted (2 x 52 bytes), seeds (136), motion (56), output (64); grid
/// nodes at 8 a cell. Distances from walls that are thin (16).
std::uint64_t bytes_of_particle(bool colliders) { return colliders ? 416 : 400; }

/// Refuses before sampling what could never be held.
void check_fits_memory(const model::Body& body, const model::Scene& scene, const Meshes& meshes,
                       std::uint64_t available) {
  const model::Space& space = scene.space;
  const bool colliders = !scene.colliders.empty();
  const Vec3d room = space.end() - space.min, s = shape_bounds(body.shape, space.spacing, meshes).size();
  const double one = space.spacing * space.spacing * space.spacing;
  const double expected = std::min(room.x * room.y * room.z, s.x * s.y * s.z) / one;
  if (expected > 4e9 || static_cast<double>(memory_estimate(static_cast<std::size_t>(expected * 0.2), colliders)) >
                            static_cast<double>(available))
    fail_input(
        "could hold {:.3g} particles at spacing {} m; that needs about {:.1f} GiB and {:.1f} GiB are free; use a "
        "larger space.spacing",
        expected, space.spacing, expected * static_cast<double>(bytes_of_particle(colliders)) / (1 << 30),
        static_cast<double>(available) / (1 << 30));
}

/// What is said of matter of a body that starts inside of a collider; an error if it is one.
std::optional<std::string> within_collider(const model::Scene& scene, std::size_t b, std::size_t c,
                                           const Overlap& overlap, const std::string& file, InitialState& out) {
  if (overlap.particles == 0) return std::nullopt;
  const model::Body& body = scene.bodies[b];
  const model::Collider& collider = scene.colliders[c];
  const double spacing = scene.space.spacing, dx = scene.space.dx();
  const double volume = static_cast<double>(overlap.particles) * spacing * spacing * spacing;
  const std::string lies =
      fmt::format("{:.4g} m^3 of body {} lie within collider {}", volume, body.name, collider.name);
  if (collider.holds) {
    out.notes.push_back(lies + ", which holds them");
    return std::nullopt;
  }
  std::vector<std::string> cut = body.cut;
  cut.push_back(collider.name);
  const std::string remedy = fmt::format("cut it out of the body with cut: [{}]", fmt::join(cut, ", "));
  if (overlap.depth > shallow_overlap * dx)
    return fmt::format("{}: error: {}, up to {:.2g} m deep: {}, or say holds: true of the collider",
                       place(file, scene, body), lies, overlap.depth, remedy);
  out.warnings.push_back(
      fmt::format("{}, up to {:.2g} m deep, and will be pressed out of it: {}", lies, overlap.depth, remedy));
  return std::nullopt;
}

/// The speed of free fall [m/s] from the highest point to the lowest floor along `gravity`.
double fall_speed(const Vec3d& gravity, const model::Scene& scene, const std::vector<Filling>& fillings) {
  const double g = length(gravity);
  if (g == 0) return 0;
  const Vec3d up = gravity / -g;
  double top = -1e30, bottom = 1e30;
  for (const Filling& f : fillings)
    for (const Vec3d& p : f.points) top = std::max(top, dot(p, up));
  const Vec3d end = scene.space.end();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{corner & 1 ? end.x : scene.space.min.x, corner & 2 ? end.y : scene.space.min.y,
                  corner & 4 ? end.z : scene.space.min.z};
    bottom = std::min(bottom, dot(p, up));
  }
  return std::sqrt(2 * g * std::max(0.0, top - bottom));
}

/// The part of the scene that the field acts in, and what of it matter comes from. A field's own
/// box may be entered at any side, and so may the space along periodic axes.
Passage passage_of(const model::ForceField& field, const model::Space& space, const Box3d& matter) {
  const Vec3d end = space.end();
  Passage p{matter, {space.min, end}, space.periodic};
  for (int a = 0; a < 3; ++a)
    if (p.endless[static_cast<std::size_t>(a)]) p.from.min[a] = space.min[a], p.from.max[a] = end[a];
  if (field.box) {
    p.within = {max(space.min, field.box->min), min(end, field.box->max)};
    p.from = p.within;
  }
  return p;
}

/// Energies add up: those of falling and of what fields give on the way. Matter has its own speed
/// besides.
ExpectedSpeed expected_speed(const model::Scene& scene, std::vector<Filling> fillings, const World<double>& world) {
  double thrown = 0, head = 0;
  for (const model::Body& b : scene.bodies) thrown = std::max(thrown, length(b.velocity));
  for (const Filling& f : fillings)
    for (const Vec3d& v : f.velocities) thrown = std::max(thrown, length(v));
  for (const Emitter& e : world.emitters) {
    const Box3d box = e.shape->bounds();
    thrown = std::max(thrown, e.fastest(0, std::numeric_limits<double>::infinity()));
    fillings.push_back({nullptr, {box.min, box.max}, {}, {}});
    if (e.path)
      for (const PoseKey& key : e.path->keys) {
        const Pose pose = e.path->pose_at(key.t);
        fillings.push_back({nullptr, {pose(box.min), pose(box.max)}, {}, {}});
      }
  }
  double fall = fall_speed(scene.gravity, scene, fillings);
  for (const Key<Vec3d>& k : scene.gravity_keys) fall = std::max(fall, fall_speed(k.value, scene, fillings));

  Box3d matter;
  for (const Filling& f : fillings)
    for (const Vec3d& p : f.points) matter.add(p);
  ExpectedSpeed out;
  const auto report = [&](const std::string& what, double speed) {
    if (speed > 0) out.sources += fmt::format("{} {} {:.3g} m/s", out.sources.empty() ? ":" : ",", what, speed);
  };
  report("fall", fall);
  for (const model::ForceField& f : scene.fields) {
    const Passage passage = passage_of(f, scene.space, matter);
    const double gives =
        passage.within.empty() ? 0 : std::visit([&](const auto& field) { return field.head(passage); }, make_field(f));
    report("field " + f.name, std::sqrt(2 * gives));
    head += gives;
  }
  double pushed = 0;
  for (const Collider& c : world.colliders)
    if (c.path || c.changing)
      pushed = std::max(pushed, c.fastest(world.domain(), 0, std::numeric_limits<double>::max()));
  report("bodies", thrown);
  report("colliders", pushed);
  if (head == 0 && pushed == 0) out.sources.clear();
  out.speed = (head > 0 ? std::sqrt(fall * fall + 2 * head) : fall) + std::max(thrown, pushed);
  return out;
}

void derive_bulk_modulus(model::Material& material, const ExpectedSpeed& expected, std::vector<std::string>& notes) {
  if (!info_of(material).find("max_compression") || material.values.has("bulk_modulus")) return;
  const double density = material.values["density"];
  // Without fall or speed a slow sound still has to hold the liquid together.
  const double c = std::max(expected.speed, 0.1) / std::sqrt(material.values["max_compression"]);
  material.values.set("bulk_modulus", density * c * c);
  notes.push_back(
      fmt::format("{}: bulk modulus {:.4g} Pa, sound speed {:.3g} m/s, from the largest expected speed {:.3g} m/s{}",
                  material.name, density * c * c, c, expected.speed, expected.sources));
}

/// A liquid's J follows the measured density at the pace of its flow: tau = 30 dx/v_ref (LIQUID),
/// which laws know as 300 dx/c, with c = 10 v_ref. One that is much stiffer would be repacked at
/// the pace of its sound, and be thrown apart by an energy that no fall has: the pace of c = 20
/// v_ref is the most. Nothing is changed where no speed is known beforehand.
void limit_relaxation(model::Material& material, double v_ref, std::vector<std::string>& notes) {
  if (!info_of(material).find("relaxation") || !material.values.has("bulk_modulus") || !(v_ref > 0)) return;
  const double c = std::sqrt(material.values["bulk_modulus"] / material.values["density"]), most = 20 * v_ref;
  const double given = material.values["relaxation"];
  if (c <= most || given == 0) return;
  material.values.set("relaxation", given * most / c);
  notes.push_back(
      fmt::format("{}: relaxation {:.3g} acts as {:.3g}, since sound is {:.3g} times the largest expected speed",
                  material.name, given, given * most / c, c / v_ref));
}

std::string too_much(std::size_t particles, std::uint64_t bytes, std::uint64_t available) {
  return fmt::format("{} particles need about {:.1f} GiB and {:.1f} GiB are free; use a larger space.spacing",
                     particles, static_cast<double>(bytes) / (1 << 30), static_cast<double>(available) / (1 << 30));
}

/// What the scene's start says; nothing without one.
std::optional<StartInfo> start_of(const model::Scene& scene, const std::string& file,
                                  std::vector<std::string>& errors) {
  if (scene.start.empty()) return std::nullopt;
  try {
    const StartInfo info = start_info(scene.start);
    if (info.frame > scene.time.frames)
      errors.push_back(fmt::format(
          "{}: error: start: {} is at frame {}, t = {:.6g} s, and time.frames is {}: frames count from t = 0, "
          "so give {} or more",
          file, scene.start, info.frame, info.time, scene.time.frames, info.frame));
    return info;
  } catch (const InputError& e) {
    errors.push_back(fmt::format("{}: error: start: {}", file, e.what()));
    return std::nullopt;
  }
}

}  // namespace

std::size_t InitialState::particles() const {
  std::size_t n = 0;
  for (const auto& set : seeds) n += set.size();
  for (const std::size_t count : started) n += count;
  return n;
}

std::uint64_t memory_estimate(std::size_t particles, bool colliders) {
  return bytes_of_particle(colliders) * particles + (64ull << 20);
}

InitialState assemble(const model::Scene& scene, const std::string& file, std::span<const Collider> standing) {
  InitialState out;
  const model::Space& space = scene.space;
  const double spacing = space.spacing;
  const std::uint64_t available = available_memory_bytes();
  const Meshes files(Meshes::Say::keep);
  const MeshRegions meshes = files.regions();
  VolumeCheck volumes(spacing, files);
  std::vector<Filling> fillings;
  std::size_t total = 0;
  std::vector<std::string> errors = projection_refusals(scene, file);
  const std::optional<StartInfo> started = start_of(scene, file, errors);
  if (started)
    for (const auto& [material, count] : started->particles) total += count;
  if (const std::uint64_t bytes = memory_estimate(total, !scene.colliders.empty()); total > 0 && bytes > available)
    fail_input("{}: error: {}", file, too_much(total, bytes, available));
  for (const model::Body& body : scene.bodies) {
    Hash64 name;
    name.add(std::string_view(body.name));
    const Sampling sampling{body.pattern, scene.seed ^ name.value()};
    try {
      if (!std::holds_alternative<PointsShape>(body.shape.form)) check_fits_memory(body, scene, files, available);
      fillings.push_back(fill(body, scene, files, sampling));
    } catch (const InputError& e) {
      errors.push_back(fmt::format("{}: error: body {}: {}", place(file, scene, body), body.name, e.what()));
      continue;
    }
    const auto& [region, points, velocities, cut] = fillings.back();
    if (points.empty())
      errors.push_back(fmt::format(
          "{}: error: body {} holds no particle at spacing {} m; make it larger or space.spacing smaller{}",
          place(file, scene, body), body.name, spacing, finer_spacing(body.shape, spacing, sampling, files)));
    else if (region)
      volumes.add("body " + body.name, body.shape, *region, sampling, points.size());
    else
      for (std::string& w : cloud_warnings(points, spacing, "body " + body.name)) out.warnings.push_back(std::move(w));
    if (region)
      for (std::string& n : short_of_walls(body, region->bounds(), space)) out.notes.push_back(std::move(n));
    for (std::string& e : outside_walls(body, points, scene, file)) errors.push_back(std::move(e));
    if (auto e = beyond_open_sides(body, points, scene, file, out.warnings)) errors.push_back(std::move(*e));
    total += points.size();
    if (const std::uint64_t bytes = memory_estimate(total, !scene.colliders.empty()); bytes > available)
      fail_input("{}: error: {}", file, too_much(total, bytes, available));
  }
  if (scene.colliders.size() > model::most_colliders)
    fail_input("{}: error: {} colliders, rigid bodies and pins; at most {}", file, scene.colliders.size(),
               model::most_colliders);
  for (const model::Collider& c : scene.colliders) try {
      const auto there =
          std::find_if(standing.begin(), standing.end(), [&](const Collider& s) { return s.name == c.name; });
      if (there != standing.end()) {
        out.world.colliders.push_back(*there);
        continue;
      }
      out.world.colliders.push_back({c.name, collider_region(c, space, files), c.type, c.friction, c.sticky, c.holds});
      out.world.colliders.back().path = motion_path(c.motion, c.shape, space.spacing, files);
      out.world.colliders.back().changing = mesh_sequence(c, space);
      out.world.colliders.back().take_shape();
      out.world.colliders.back().follow(0, 1 / scene.time.fps);
      out.world.colliders.back().surface_pose = out.world.colliders.back().pose;
    } catch (const InputError& e) {
      errors.push_back(fmt::format("{}: error: collider {}: {}", place(file, scene, c), c.name, e.what()));
    }
  const auto refuse = [&] {
    if (errors.empty()) return;
    for (const std::string& w : files.warnings()) warn("{}", w);  // what was mended may be what went wrong
    throw InputError(fmt::format("{}", fmt::join(errors, "\n")));
  };
  refuse();
  for (const auto& lines : {files.warnings(), volumes.warnings()})
    out.warnings.insert(out.warnings.end(), lines.begin(), lines.end());
  // What is said of colliders was said when they came in.
  if (standing.empty())
    for (auto& note : notes_on(scene, file, files)) out.notes.push_back(std::move(note));

  World<double>& w = out.world;
  w.dx = space.dx();
  w.origin = space.min;
  w.walls = space.walls;
  w.periodic = space.periodic;
  w.set_domain(space.cells());
  w.gravity = scene.gravity;
  w.gravity_keys = scene.gravity_keys;
  w.settings.fps = scene.time.fps;
  w.settings.solver = scene.time.solver;
  w.settings.cfl = scene.time.cfl;
  w.settings.fixed_dt = scene.time.dt.value_or(0);
  w.settings.dt_max = scene.time.dt_max.value_or(1e30);
  w.settings.damping = scene.time.damping;
  w.settings.surface_contact = scene.time.surface_contact;
  for (const model::ForceField& f : scene.fields) w.fields.push_back({f.name, make_field(f), f.box});
  add_inflow(w, scene, files, file, errors);
  // Of colliders that stand already only matter comes.
  if (standing.empty()) add_rigid(w, scene, file, errors);
  for (std::size_t b = 0; b < fillings.size(); ++b)
    if (auto error = cut_out(fillings[b], scene, b, w, file)) errors.push_back(std::move(*error));
  for (std::size_t a = 0; a < fillings.size(); ++a)
    for (std::size_t b = a + 1; b < fillings.size(); ++b)
      if (const double volume = common_volume(fillings[a], fillings[b], w, spacing); volume > 0)
        out.warnings.push_back(fmt::format("bodies {} and {} overlap by {:.4g} m^3: matter is there twice",
                                           scene.bodies[a].name, scene.bodies[b].name, volume));
  std::uint64_t pools = 0;
  for (const Emitter& e : w.emitters) pools += e.pool;
  if (const std::uint64_t bytes = memory_estimate(total + pools, !scene.colliders.empty());
      pools > 0 && bytes > available)
    errors.push_back(fmt::format(
        "{}: error: {} particles and {} in the pools of emitters need about {:.1f} GiB and "
        "{:.1f} GiB are free; give smaller pools, or use a larger space.spacing",
        file, total, pools, static_cast<double>(bytes) / (1 << 30), static_cast<double>(available) / (1 << 30)));
  out.expected = started ? started->expected : expected_speed(scene, fillings, w);
  for (std::size_t c = 0; c < scene.colliders.size(); ++c)
    for (std::size_t b = 0; b < fillings.size(); ++b) {
      const Overlap overlap = matter_inside(fillings[b].points, w, c);
      if (auto error = within_collider(scene, b, c, overlap, file, out)) errors.push_back(std::move(*error));
    }
  refuse();
  if (standing.empty())
    for (std::string& line : thin_collider_warnings(w, space)) out.warnings.push_back(std::move(line));
  if (std::string line = projection_warning(scene, file); !line.empty()) out.warnings.push_back(std::move(line));
  for (const model::Material& material : scene.materials) {
    ParticleSet<double>& set = w.sets.emplace_back();
    set.rest_volume = spacing * spacing * spacing;
    use_material(set, material, w, out.expected, out.notes);
  }

  if (started)
    for (const ParticleSet<double>& set : w.sets) out.started.push_back(started->count(set.name));
  out.seeds.resize(w.sets.size());
  std::uint32_t id = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const model::Body& body = scene.bodies[b];
    const auto& points = fillings[b].points;
    Vec3d middle{};
    for (const Vec3d& p : points) middle += p;
    middle = middle / static_cast<double>(points.size());
    const Vec3d& o = body.spin;
    const Mat3d gradient{{0, -o.z, o.y, o.z, 0, -o.x, -o.y, o.x, 0}};
    out.bodies.push_back({body.name, id, static_cast<std::uint32_t>(points.size()), body.color});
    auto& set = out.seeds[index_of(scene.materials, body.material)];
    const std::vector<Vec3d>& own = fillings[b].velocities;
    for (std::size_t p = 0; p < points.size(); ++p)
      set.push_back(
          {id++, points[p], body.velocity + cross(o, points[p] - middle) + (own.empty() ? Vec3d{} : own[p]), gradient});
  }
  if (!w.emitters.empty()) w.next_id = id;
  return out;
}

template <class R>
void use_material(ParticleSet<R>& set, model::Material material, const World<R>& world, const ExpectedSpeed& expected,
                  std::vector<std::string>& notes) {
  // A projection has no use for stiffness.
  set.carries_motion = world.settings.solver == SolverKind::projection;
  const bool projected = set.carries_motion && info_of(material).liquid;
  if (projected && material.values.has("bulk_modulus"))
    notes.push_back(fmt::format("{}: bulk_modulus has no effect: a projection keeps volume as it is", material.name));
  std::vector<std::string> unused;
  std::vector<std::string>& of_stiffness = projected ? unused : notes;
  derive_bulk_modulus(material, expected, of_stiffness);
  limit_relaxation(material, expected.speed, of_stiffness);
  set.name = material.name;
  set.material = material.type;
  set.liquid = info_of(material).liquid;
  set.mass = material.values["density"] * set.rest_volume;
  set.values = material.values;
  double gravity = length(world.gravity);
  for (const Key<Vec3d>& k : world.gravity_keys) gravity = std::max(gravity, length(k.value));
  const CellTimes cell{world.dx / facts_of(info_of(material), material.values).sound_speed,
                       set.liquid && gravity > 0 ? std::sqrt(world.dx / gravity) : 0};
  set.transfer = std::visit([&](const auto& t) { return t.rule(cell); },
                            make_transfer(material.transfer, material.transfer_values));
}
#define DM_INSTANTIATE(R)                                                                             \
  template void use_material(ParticleSet<R>&, model::Material, const World<R>&, const ExpectedSpeed&, \
                             std::vector<std::string>&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

template <class R>
World<R> as_world(const World<double>& empty) {
  World<R> w;
  visit_fields(w, empty, [&]<class F, class T>(const F&, T& to, const auto& from) {
    if constexpr (std::is_same_v<T, std::vector<ParticleSet<R>>>)
      for (const auto& s : from)
        visit_fields(to.emplace_back(), s, []<class Member>(const Member&, auto& its, const auto& given) {
          if constexpr (Member::use.copied) its = given;
        });
    else if constexpr (F::use.copied)
      to = from;
  });
  return w;
}
template World<float> as_world(const World<double>&);
template World<double> as_world(const World<double>&);

}  // namespace dreampm
