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
#include "dreampm/setup/body_checks.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/expected_speed.h"
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

/// Returns the message for matter of a body that starts inside of a collider, if it is an error.
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

std::string too_much(std::size_t particles, std::uint64_t bytes, std::uint64_t available) {
  return fmt::format("{} particles need about {:.1f} GiB and {:.1f} GiB are free; use a larger space.spacing",
                     particles, static_cast<double>(bytes) / (1 << 30), static_cast<double>(available) / (1 << 30));
}

/// Returns the data of the scene's start; nothing without one.
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

/// The parts of `assemble`, in their order.
class Assembly {
 public:
  Assembly(const model::Scene& scene, const std::string& file)
      : scene_(scene),
        file_(file),
        volumes_(scene.space.spacing, files_),
        errors_(projection_refusals(scene, file)),
        started_(start_of(scene, file, errors_)) {}

  void fill_bodies();
  void place_colliders(std::span<const Collider> standing);
  /// Colliders as they stand now, by name: edits may have brought them in another order.
  void note_what_is_there(bool at_the_start);
  /// Box, forces and settings, and what comes in and out.
  void set_up_world(bool with_rigid);
  void cut_bodies();
  void check_pools();
  void check_overlaps();
  void collect_warnings(bool at_the_start);
  void make_sets();
  void number_seeds();
  /// Throws what is wrong so far.
  void refuse() const;
  InitialState take() { return std::move(out_); }

 private:
  void fill_body(const model::Body& body);
  void check_memory(std::size_t particles) const {
    if (const std::uint64_t bytes = memory_estimate(particles, !scene_.colliders.empty()); bytes > available_)
      fail_input("{}: error: {}", file_, too_much(particles, bytes, available_));
  }

  const model::Scene& scene_;
  const std::string& file_;
  const std::uint64_t available_ = available_memory_bytes();
  const Meshes files_{Meshes::Say::keep};
  VolumeCheck volumes_;
  std::vector<std::string> errors_;
  std::optional<StartInfo> started_;
  std::vector<Filling> fillings_;  ///< of the scene's bodies
  std::size_t total_ = 0;          ///< particles
  InitialState out_;
};

void Assembly::refuse() const {
  if (errors_.empty()) return;
  for (const std::string& w : files_.warnings()) warn("{}", w);  // what was mended may be what went wrong
  throw InputError(fmt::format("{}", fmt::join(errors_, "\n")));
}

void Assembly::fill_bodies() {
  if (started_)
    for (const auto& [material, count] : started_->particles) total_ += count;
  if (total_ > 0) check_memory(total_);
  for (const model::Body& body : scene_.bodies) fill_body(body);
}

void Assembly::fill_body(const model::Body& body) {
  const model::Space& space = scene_.space;
  const double spacing = space.spacing;
  Hash64 name;
  name.add(std::string_view(body.name));
  const Sampling sampling{body.pattern, scene_.seed ^ name.value()};
  try {
    if (!std::holds_alternative<PointsShape>(body.shape.form)) check_fits_memory(body, scene_, files_, available_);
    fillings_.push_back(fill(body, scene_, files_, sampling));
  } catch (const InputError& e) {
    errors_.push_back(fmt::format("{}: error: body {}: {}", place(file_, scene_, body), body.name, e.what()));
    return;
  }
  const auto& [region, points, velocities, cut] = fillings_.back();
  if (points.empty())
    errors_.push_back(fmt::format(
        "{}: error: body {} holds no particle at spacing {} m; make it larger or space.spacing smaller{}",
        place(file_, scene_, body), body.name, spacing, finer_spacing(body.shape, spacing, sampling, files_)));
  else if (region)
    volumes_.add("body " + body.name, body.shape, *region, sampling, points.size());
  else
    for (std::string& w : cloud_warnings(points, spacing, "body " + body.name)) out_.warnings.push_back(std::move(w));
  if (region)
    for (std::string& n : short_of_walls(body, region->bounds(), space)) out_.notes.push_back(std::move(n));
  for (std::string& e : outside_walls(body, points, scene_, file_)) errors_.push_back(std::move(e));
  if (auto e = beyond_open_sides(body, points, scene_, file_, out_.warnings)) errors_.push_back(std::move(*e));
  total_ += points.size();
  check_memory(total_);
}

void Assembly::place_colliders(std::span<const Collider> standing) {
  if (scene_.colliders.size() > model::most_colliders)
    fail_input("{}: error: {} colliders, rigid bodies and pins; at most {}", file_, scene_.colliders.size(),
               model::most_colliders);
  for (const model::Collider& c : scene_.colliders) try {
      // By name: edits may have brought them in another order.
      const auto there =
          std::find_if(standing.begin(), standing.end(), [&](const Collider& now) { return now.name == c.name; });
      out_.world.colliders.push_back(there != standing.end() ? *there : make_collider(c, scene_, 0, files_));
    } catch (const InputError& e) {
      errors_.push_back(fmt::format("{}: error: collider {}: {}", place(file_, scene_, c), c.name, e.what()));
    }
}

void Assembly::note_what_is_there(bool at_the_start) {
  for (const auto& lines : {files_.warnings(), volumes_.warnings()})
    out_.warnings.insert(out_.warnings.end(), lines.begin(), lines.end());
  // Messages about colliders were given when they came in.
  if (!at_the_start) return;
  for (auto& note : notes_on(scene_, file_, files_)) out_.notes.push_back(std::move(note));
}

void Assembly::set_up_world(bool with_rigid) {
  const model::Space& space = scene_.space;
  World<double>& w = out_.world;
  w.dx = space.dx();
  w.origin = space.min;
  w.walls = space.walls;
  w.periodic = space.periodic;
  w.set_domain(space.cells());
  w.gravity = scene_.gravity;
  w.gravity_keys = scene_.gravity_keys;
  w.settings.fps = scene_.time.fps;
  w.settings.solver = scene_.time.solver;
  w.settings.cfl = scene_.time.cfl;
  w.settings.fixed_dt = scene_.time.dt.value_or(0);
  w.settings.dt_max = scene_.time.dt_max.value_or(1e30);
  w.settings.damping = scene_.time.damping;
  w.settings.surface_contact = scene_.time.surface_contact;
  for (const model::ForceField& f : scene_.fields) w.fields.push_back({f.name, make_field(f), f.box});
  add_inflow(w, scene_, files_, file_, errors_);
  if (with_rigid) add_rigid(w, scene_, file_, errors_);
}

void Assembly::cut_bodies() {
  for (std::size_t b = 0; b < fillings_.size(); ++b)
    if (auto error = cut_out(fillings_[b], scene_, b, out_.world, file_)) errors_.push_back(std::move(*error));
  for (std::size_t a = 0; a < fillings_.size(); ++a)
    for (std::size_t b = a + 1; b < fillings_.size(); ++b)
      if (const double volume = common_volume(fillings_[a], fillings_[b], out_.world, scene_.space.spacing); volume > 0)
        out_.warnings.push_back(fmt::format("bodies {} and {} overlap by {:.4g} m^3: matter is there twice",
                                            scene_.bodies[a].name, scene_.bodies[b].name, volume));
}

void Assembly::check_pools() {
  std::uint64_t pools = 0;
  for (const Emitter& e : out_.world.emitters) pools += e.pool;
  if (const std::uint64_t bytes = memory_estimate(total_ + pools, !scene_.colliders.empty());
      pools > 0 && bytes > available_)
    errors_.push_back(fmt::format(
        "{}: error: {} particles and {} in the pools of emitters need about {:.1f} GiB and "
        "{:.1f} GiB are free; give smaller pools, or use a larger space.spacing",
        file_, total_, pools, static_cast<double>(bytes) / (1 << 30), static_cast<double>(available_) / (1 << 30)));
}

void Assembly::check_overlaps() {
  for (std::size_t c = 0; c < scene_.colliders.size(); ++c)
    for (std::size_t b = 0; b < fillings_.size(); ++b) {
      const Overlap overlap = matter_inside(fillings_[b].points, out_.world, c);
      if (auto error = within_collider(scene_, b, c, overlap, file_, out_)) errors_.push_back(std::move(*error));
    }
}

void Assembly::collect_warnings(bool at_the_start) {
  if (!at_the_start) return;
  for (std::string& line : thin_collider_warnings(out_.world, scene_.space)) out_.warnings.push_back(std::move(line));
  if (std::string line = projection_warning(scene_, file_); !line.empty()) out_.warnings.push_back(std::move(line));
}

void Assembly::make_sets() {
  const double spacing = scene_.space.spacing;
  out_.expected = started_ ? started_->expected : expected_speed(scene_, fillings_, out_.world);
  for (const model::Material& material : scene_.materials) {
    ParticleSet<double>& set = out_.world.sets.emplace_back();
    set.rest_volume = spacing * spacing * spacing;
    use_material(set, material, out_.world, out_.expected, out_.notes);
  }
  if (started_)
    for (const ParticleSet<double>& set : out_.world.sets) out_.started.push_back(started_->count(set.name));
}

void Assembly::number_seeds() {
  out_.seeds.resize(out_.world.sets.size());
  std::uint32_t id = 0;
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const model::Body& body = scene_.bodies[b];
    const auto& points = fillings_[b].points;
    Vec3d middle{};
    for (const Vec3d& p : points) middle += p;
    middle = middle / static_cast<double>(points.size());
    const Vec3d& o = body.spin;
    const Mat3d gradient{{0, -o.z, o.y, o.z, 0, -o.x, -o.y, o.x, 0}};
    out_.bodies.push_back({body.name, id, static_cast<std::uint32_t>(points.size()), body.color});
    auto& set = out_.seeds[index_of(scene_.materials, body.material)];
    const std::vector<Vec3d>& own = fillings_[b].velocities;
    for (std::size_t p = 0; p < points.size(); ++p)
      set.push_back(
          {id++, points[p], body.velocity + cross(o, points[p] - middle) + (own.empty() ? Vec3d{} : own[p]), gradient});
  }
  if (!out_.world.emitters.empty()) out_.world.next_id = id;
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
  Assembly assembly(scene, file);
  assembly.fill_bodies();
  assembly.place_colliders(standing);
  assembly.refuse();
  assembly.note_what_is_there(standing.empty());
  // Matter alone is added to colliders that stand already.
  assembly.set_up_world(standing.empty());
  assembly.cut_bodies();
  assembly.check_pools();
  assembly.check_overlaps();
  assembly.refuse();
  assembly.collect_warnings(standing.empty());
  assembly.make_sets();
  assembly.number_seeds();
  return assembly.take();
}

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
