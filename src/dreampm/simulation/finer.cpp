#include "dreampm/simulation/finer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "dreampm/backend/registry.h"
#include "dreampm/base/narrow.h"
#include "dreampm/run/engine.h"
#include "dreampm/setup/start.h"
#include "dreampm/solver/motion_by_id.h"
#include "dreampm/state/particle_state.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// Spacings: how far from a wall or a collider the nearest particles are.
constexpr double just_outside = 0.02;
constexpr std::uint32_t parts = 8;

constexpr std::array<std::string_view, 9> gradient_names{"f_00", "f_01", "f_02", "f_10", "f_11",
                                                         "f_12", "f_20", "f_21", "f_22"};

/// Returns the deformation of particle `p`; identity where its material does not keep that.
template <class R>
Mat3d deformation(const ParticleSetView<R>& particles, std::string_view material, std::size_t p) {
  if (!find_column(material, gradient_names.front())) return Mat3d::identity();
  Mat3d f;
  for (int k = 0; k < 9; ++k)
    f(k / 3, k % 3) = static_cast<double>(particles.column(gradient_names[static_cast<std::size_t>(k)])[p]);
  // Matter drawn out farther than this is one thread, and no cube.
  constexpr double most = 4;
  return norm2(f) < most * most ? f : Mat3d::identity();
}

/// Returns the middle of an eighth of a particle's cube, from the cube's middle [half edges].
Vec3d corner(std::uint32_t part) { return {part & 1 ? 0.5 : -0.5, part & 2 ? 0.5 : -0.5, part & 4 ? 0.5 : -0.5}; }

template <class R>
class Refinement {
 public:
  Refinement(const World<R>& coarse, const Motion<R>& motion, World<R> empty)
      : coarse_(coarse),
        motion_(motion),
        world_(std::move(empty)),
        margin_(just_outside * world_.sets.front().spacing()) {
    number_wholes();
    take_clock();
    take_arrivals();
  }

  /// Fills the world; how its particles move.
  Motion<R> take() {
    MotionById<R> by_id(coarse_.sets.size());
    for (std::size_t s = 0; s < coarse_.sets.size(); ++s) {
      std::vector<ParticleSeed> seeds;
      const ParticleSetView<R> particles(coarse_, s);
      particles.for_each([&](std::size_t p, const Vec3d& x) {
        const Mat3d shape = deformation(particles, coarse_.sets[s].material, p);
        const auto v = static_cast<Vec3d>(motion_.sets[s].velocity[p]);
        const auto c = static_cast<Mat3d>(motion_.sets[s].gradient[p]);
        const std::uint32_t first = first_part(particles.id(p));
        for (std::uint32_t part = 0; part < parts; ++part) {
          const Vec3d off = shape * (corner(part) * world_.sets[s].spacing());
          seeds.push_back({first + part, inside(x + off), v + c * off, c});
        }
      });
      if (seeds.empty()) continue;
      by_id.add(s, seeds);
      insert<R>(world_, s, seeds);
      take_state(s);
    }
    if (!world_.emitters.empty()) world_.next_id = parts * static_cast<std::uint32_t>(wholes_.size());
    Motion<R> motion = by_id.ordered(world_);
    for (std::size_t s = 0; s < motion.sets.size(); ++s)
      for (std::size_t p = 0; p < motion.sets[s].energy.size(); ++p) {
        const std::size_t whole = whole_of(s, p);
        motion.sets[s].energy[p] = motion_.sets[s].energy[whole];
        motion.sets[s].volume_ratio[p] = motion_.sets[s].volume_ratio[whole];
      }
    return motion;
  }

  World<R>& world() { return world_; }

 private:
  struct Whole {
    std::uint32_t id;
    std::size_t p;  ///< its place in its set
  };

  /// Parts have the order of their wholes by id, so that what came in together stays one range.
  void number_wholes() {
    for (std::size_t s = 0; s < coarse_.sets.size(); ++s) {
      const std::span<const std::uint32_t> ids = ParticleSetView<R>(coarse_, s).ids();
      for (std::size_t p = 0; p < ids.size(); ++p) wholes_.push_back({ids[p], p});
    }
    narrow<std::uint32_t>(wholes_.size() * parts, "particles");
    std::ranges::sort(wholes_, {}, &Whole::id);
  }
  /// The id of the first part of particle `id`, or of the next one that is there.
  std::uint32_t first_part(std::uint64_t id) const {
    return parts * static_cast<std::uint32_t>(std::ranges::lower_bound(wholes_, id, {}, &Whole::id) - wholes_.begin());
  }

  void take_arrivals() {
    for (const Arrival& a : coarse_.arrivals) {
      const std::uint32_t first = first_part(a.first_id), end = first_part(std::uint64_t{a.first_id} + a.count);
      if (end > first) world_.arrivals.push_back({first, end - first, a.emitter, a.time});
    }
  }

  void take_clock() {
    world_.step = coarse_.step, world_.frame = coarse_.frame, world_.time = coarse_.time;
    world_.emitted_until = coarse_.emitted_until, world_.left = coarse_.left * parts;
    for (std::size_t c = 0; c < world_.colliders.size(); ++c) {
      Collider& to = world_.colliders[c];
      const Collider& from = coarse_.colliders[c];
      to.pose = from.pose, to.twist = from.twist, to.surface_pose = from.surface_pose;
      to.time = from.time, to.surface_time = from.surface_time;
      to.take_shape();
    }
    for (std::size_t e = 0; e < world_.emitters.size(); ++e) {
      world_.emitters[e].born = coarse_.emitters[e].born * parts;
      world_.emitters[e].dry = coarse_.emitters[e].dry;
    }
  }

  Vec3d inside(Vec3d x) const {
    const Box3d box = world_.domain();
    for (int a = 0; a < 3; ++a)
      if (!world_.periodic[static_cast<std::size_t>(a)])
        x[a] = std::clamp(x[a], box.min[a] + margin_, box.max[a] - margin_);
    for (const Collider& c : world_.colliders)
      if (const double d = c.holds ? margin_ : c.distance(x); d < margin_) x = x + c.normal(x) * (margin_ - d);
    return x;
  }

  /// The particle that particle `p` is a part of.
  std::size_t whole_of(std::size_t s, std::size_t p) const {
    return wholes_[ParticleSetView<R>(world_, s).id(p) / parts].p;
  }

  /// Each part has the state of the whole.
  void take_state(std::size_t s) {
    ParticleSet<R>& set = world_.sets[s];
    const ParticleSetView<R> from(coarse_, s);
    Materials::with(set.material, [&]<class M>() {
      for (const std::string_view name : M::template State<R>::names) {
        LargeVector<R>& column = state_column(set, name);
        for (std::size_t p = 0; p < column.size(); ++p) column[p] = from.column(name)[whole_of(s, p)];
      }
    });
  }

  const World<R>& coarse_;
  const Motion<R>& motion_;
  World<R> world_;
  double margin_;
  std::vector<Whole> wholes_;  ///< by rising ids
};

}  // namespace

template <class R>
void write_finer(const std::filesystem::path& file, const World<R>& coarse, const Motion<R>& motion,
                 const model::Scene& scene, const std::string& scene_file, const ExpectedSpeed& expected) {
  model::Scene unwritten = scene;  // its start is yet to be written
  unwritten.start.clear();
  const InitialState start = assemble(unwritten, scene_file);
  World<R> empty = as_world<R>(start.world);
  std::vector<std::string> notes;
  for (std::size_t s = 0; s < empty.sets.size(); ++s)
    use_material(empty.sets[s], scene.materials[s], empty, expected, notes);
  Refinement<R> refinement(coarse, motion, std::move(empty));
  const Motion<R> fine = refinement.take();
  const std::string backend = std::is_same_v<R, float> ? "cpu" : "reference";
  Engine<R> engine({}, std::get<std::unique_ptr<Backend<R>>>(make_backend(backend, "auto")));
  engine.replace(std::move(refinement.world()), &fine);
  engine.form_grid();
  engine.download(MatterFields::all);
  write_start(file, engine.world(), engine.motion(), expected);
}

template void write_finer(const std::filesystem::path&, const World<float>&, const Motion<float>&, const model::Scene&,
                          const std::string&, const ExpectedSpeed&);
template void write_finer(const std::filesystem::path&, const World<double>&, const Motion<double>&,
                          const model::Scene&, const std::string&, const ExpectedSpeed&);

}  // namespace dreampm
