#include "dreampm/play/model/readback.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "dreampm/math/look_color.h"
#include "dreampm/math/rng.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/cell_means.h"
#include "dreampm/play/model/controls.h"
#include "dreampm/play/model/facts.h"
#include "dreampm/play/model/live_range.h"
#include "dreampm/play/model/play_model.h"
#include "dreampm/play/model/solver_choice.h"

namespace dreampm::play {
namespace {

/// A number that matter can be colored by: its name, the attribute of particles, or none for speed
/// and age, which begin at 0, and where its scale lies: at least around `middle` as far as `least`.
/// `of_cell`: as a mean over a cell, because single particles jump.
struct Coloring {
  std::string_view choice, attribute, unit;
  float middle, least;
  bool of_cell = false;
};
constexpr Coloring colorings[] = {{"speed", "", "m/s", 0, 0.5f},
                                  {"pressure", "pressure", "Pa", 0, 100, true},
                                  {"J", "j", "", 1, 0.02f},
                                  {"Jp", "jp", "", 1, 0.05f},
                                  {"age", "", "s", 0, 0.5f}};

/// The values between which nineteen of twenty lie, and the middle as far as the least.
std::array<float, 2> range_of(const Frame& frame, const Coloring& coloring) {
  std::vector<float> all;
  for (const MatterFrame& m : frame.matter)
    for (std::size_t i = 0; i < m.value.size(); i += 1 + m.value.size() / 2000) all.push_back(m.value[i]);
  if (all.empty()) return {coloring.middle, coloring.middle + coloring.least};
  std::sort(all.begin(), all.end());
  const std::size_t off = all.size() / 40;
  const bool from_zero = coloring.attribute.empty();
  return {from_zero ? 0 : std::min(all[off], coloring.middle - coloring.least),
          std::max(all[all.size() - 1 - off], coloring.middle + coloring.least)};
}

/// A bright color for each id.
std::array<std::uint8_t, 4> random_color(std::uint32_t id) {
  std::array<std::uint8_t, 4> color{0, 0, 0, 255};
  for (std::uint64_t a = 0; a < 3; ++a) color[a] = static_cast<std::uint8_t>(60 + 195 * uniform(id, a));
  return color;
}

/// A way on, which ends at the walls of a box that the place is in.
Vec3d moved(const Vec3d& from, const Vec3d& way, const Box3d& box) {
  return box.contains(from) ? max(min(from + way, box.max), box.min) : from + way;
}

/// `ahead` [s]: how much later than the simulation matter is shown, as it moves now.
void read_positions(const Simulation& simulation, bool random_colors, double ahead, Frame& frame) {
  for (MatterFrame& matter : frame.matter) {
    matter.position.resize(simulation.particle_count(matter.name));
    matter.value.clear(), matter.color.clear();
    simulation.visit(matter.name, {.velocity = ahead != 0, .id = random_colors}, [&](const ParticleBatch& some) {
      for (std::size_t i = 0; i < some.size(); ++i) {
        const Vec3d& x = some.position[i];
        matter.position[some.first + i] =
            static_cast<Vec3f>(ahead == 0 ? x : moved(x, some.velocity[i] * ahead, frame.domain));
      }
      for (const std::uint32_t id : some.id) matter.color.push_back(random_color(id));
    });
  }
}

void read_values(const Simulation& simulation, const Coloring& coloring, const Ages& ages, double ahead, Frame& frame) {
  for (MatterFrame& m : frame.matter) {
    m.position.clear(), m.value.clear(), m.color.clear();
    const ParticleView particles = simulation.particles(m.name);
    if (!coloring.attribute.empty()) {
      const AttributeView values = simulation.attribute(m.name, coloring.attribute);
      m.value.assign(values.values.begin(), values.values.end());
    }
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vec3f &x = particles.position[i], &v = particles.velocity[i];
      m.position.push_back(
          ahead == 0 ? x
                     : static_cast<Vec3f>(moved(static_cast<Vec3d>(x), static_cast<Vec3d>(v) * ahead, frame.domain)));
      if (coloring.choice == "age")
        m.value.push_back(ages.age(particles.id[i], simulation.time()));
      else if (coloring.attribute.empty())
        m.value.push_back(length(v));
    }
  }
  if (coloring.of_cell)
    for (MatterFrame& m : frame.matter) average_over_cells(m.position, 2 * frame.spacing, m.value);
  frame.value_label = std::string(coloring.choice), frame.value_unit = std::string(coloring.unit);
  const auto [low, high] = range_of(frame, coloring);
  frame.value_min = low, frame.value_max = high;
}

/// As the scene's pictures have it, about; the report's own for its scenes.
void set_camera(const model::Scene& scene, bool report, Frame& frame) {
  const model::Camera& camera = scene.render.camera;
  constexpr double degree = std::numbers::pi / 180;
  if (report) {
    frame.eye = {0.5, 1.0, 1.95}, frame.target = {0.5, 0.3, 0.5}, frame.view_angle = 55 * degree;
    return;
  }
  frame.eye = camera.from, frame.target = camera.to, frame.view_angle = camera.fov * degree;
  if (!camera.fit_basin) return;
  const double around = camera.azimuth * degree, up = std::max(camera.elevation, 20.0) * degree;
  const Box3d box{scene.space.min, scene.space.end()};
  const double distance = 0.42 * length(box.size()) / std::sin(0.5 * frame.view_angle);
  frame.target = box.center();
  frame.eye =
      box.center() + Vec3d{std::cos(up) * std::cos(around), std::sin(up), std::cos(up) * std::sin(around)} * distance;
}

/// Tools draw theirs themselves.
bool is_drawn(const model::Collider& c, const ToolSet& tools) {
  return !c.pin && !c.sequence &&
         std::none_of(tools.begin(), tools.end(), [&](const auto& tool) { return tool->draws(c.name); });
}

BodyFrame body_of(const Simulation& simulation, const model::Collider& c) {
  const model::Look& look = simulation.scene().model().render.looks.at(c.name);
  const bool clear = is_clear(look);
  return {c.name,
          c.rigid.has_value(),
          std::make_shared<const TriMesh>(simulation.collider_mesh(c.name)),
          {},
          clear ? Vec3f{0.8f, 0.9f, 0.95f} : shown_color(look),
          clear ? 0.25f : 1.0f};
}

/// Makes `bodies` those of the scene; those of a name that was there already stay as they were.
void list_bodies(const Simulation& simulation, const ToolSet& tools, std::vector<BodyFrame>& bodies) {
  const std::vector<BodyFrame> before = std::exchange(bodies, {});
  for (const model::Collider& c : simulation.scene().model().colliders) {
    if (!is_drawn(c, tools)) continue;
    const auto known = std::find_if(before.begin(), before.end(), [&](const BodyFrame& b) { return b.name == c.name; });
    bodies.push_back(known == before.end() ? body_of(simulation, c) : *known);
  }
}

/// What the scene is, and where the simulation stands.
void read_scene(const PlayModel& side, Frame& frame) {
  const PlayScene& played = side.play_scene();
  const Simulation& simulation = *side.simulation;
  const model::Scene& scene = simulation.scene().model();
  frame.number = side.clock.ticks;
  frame.story = played.name, frame.about = scene.about;
  frame.preset_file = played.file, frame.presets = played.presets, frame.preset = played.preset;
  frame.time = simulation.time(), frame.steps = simulation.steps(), frame.particles = simulation.particle_count();
  frame.size = played.size, frame.can_resize = !played.report && played.scene.model().start.empty();
  frame.solver = static_cast<std::size_t>(scene.time.solver);
  frame.no_other = side.no_other, frame.matter_refusals = side.refusals;
  frame.domain = {scene.space.min, scene.space.end()}, frame.spacing = scene.space.spacing;
  set_camera(scene, played.report, frame);
}

/// s: how much later than the simulation matter is shown. In slow motion a large step lasts for
/// pictures on end. They show matter on its way through it, at the velocity that took it.
double time_ahead(const PlayModel& side) {
  const double dt = side.simulation->dt();
  if (!is_projection(side.simulation->scene().model()) || dt <= side.asked_seconds()) return 0;
  return std::clamp(side.clock.pending - 0.5 * dt, -side.meters.taken_dt, 0.0);
}

void read_matter(const PlayModel& side, Frame& frame) {
  const std::vector<model::Material>& materials = side.simulation->scene().model().materials;
  frame.matter.resize(materials.size());
  for (std::size_t m = 0; m < materials.size(); ++m)
    frame.matter[m].name = materials[m].name,
    frame.matter[m].look = std::make_shared<const MatterLook>(side.looks.at(materials[m].name));
  frame.value_label.clear(), frame.value_unit.clear();
  const std::string& choice = color_choices()[side.settings.color_by];
  const auto coloring =
      std::find_if(std::begin(colorings), std::end(colorings), [&](const Coloring& c) { return c.choice == choice; });
  const double ahead = time_ahead(side);
  if (coloring == std::end(colorings))
    read_positions(*side.simulation, side.settings.random_colors, ahead, frame);
  else
    read_values(*side.simulation, *coloring, side.arrivals.ages, ahead, frame);
  side.foam.show(side.simulation->time() + ahead, frame.bubbles, frame.foam);
}

/// Of the past, of films and of messages.
void read_rest(const PlayModel& side, Frame& frame) {
  Films& films = *side.films;
  frame.rendering = films.rendering ? std::make_shared<const RenderStatus>(films.rendering->look()) : nullptr;
  frame.film = films.file, frame.film_fps = films.fps;
  frame.past = side.history.first() > 0 ? side.clock.played - side.history.first() : 0;
  frame.future = std::max(0.0, side.history.last() - side.clock.played);
  frame.can_undo = side.history.can_undo(), frame.can_redo = side.history.can_redo();
  frame.message = side.message.text, frame.message_is_error = side.message.is_error;
  frame.message_number = side.message.number;
  frame.lost = lost_text(side.losses.all);
}

}  // namespace

void FrameReader::read_bodies(const PlayModel& side, Frame& frame) {
  if (bodies_of_ != side.loaded) bodies_.clear(), bodies_of_ = side.loaded;
  list_bodies(*side.simulation, side.tools, bodies_);
  frame.bodies = bodies_;
  for (BodyFrame& b : frame.bodies) b.pose = side.simulation->collider(b.name).pose;
  frame.room = frame.domain, frame.marks.clear(), frame.buttons.clear();
  for (const auto& tool : side.tools) tool->marks(side, frame);
}

void FrameReader::read_controls(const PlayModel& side, Frame& frame) {
  frame.meters = side.meters, frame.settings = side.settings;
  frame.controls = side.controls;
  frame.values = asked_values(*side.controls, side, *side.simulation);
  // They need not follow each picture.
  constexpr std::uint64_t ticks_between = 15;
  if (live_.of != side.controls || side.clock.ticks >= live_.at + ticks_between)
    live_ = {live_ranges(*side.simulation, *side.controls, frame.values,
                         side.options.step_seconds.value_or(side.cost.mean), ticks_a_second * side.asked_seconds()),
             side.controls, side.clock.ticks};
  frame.live = live_.ranges;
  frame.facts = material_facts(*side.simulation);
}

std::shared_ptr<Frame> FrameReader::read(const PlayModel& side) {
  std::shared_ptr<Frame> frame = pool_.next();
  read_scene(side, *frame);
  read_matter(side, *frame);
  read_bodies(side, *frame);
  read_controls(side, *frame);
  read_rest(side, *frame);
  return frame;
}

}  // namespace dreampm::play
