#include "dreampm/play/model/play_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dreampm/base/seconds_since.h"
#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/compare.h"
#include "dreampm/play/model/controls.h"
#include "dreampm/play/model/facts.h"
#include "dreampm/play/model/firmness.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/report/report_config.h"
#include "dreampm/play/report/report_looks.h"

namespace dreampm::play {
namespace {

/// Failures in a row after which the world begins anew instead of going back.
constexpr int most_failures = 3;
/// s: how long steps go on without asking whether the tick shall end.
constexpr double ask_every = 4e-3;
/// Cells that surfaces which move may be off. What a step knows of them is found anew less often
/// than in a run: that is a third of the time of boxes that float.
constexpr double slack_of_moving = 0.05;

void loosen_surfaces(Simulation& simulation) {
  for (const std::string& name : simulation.names().colliders)
    if (const ColliderState c = simulation.collider(name); c.moves && !c.deforms)
      simulation.set_surface_tolerance(name, std::max(c.surface_tolerance, slack_of_moving));
}

}  // namespace

PlayModel::PlayModel(PlayScene first, const PlayOptions& o) : options(o), history(o.history_bytes) {
  open(begin(std::move(first)));
}

PlayModel::Begun PlayModel::begin(PlayScene scene) const {
  ToolSet own;
  for (const auto& tool : own) tool->load(scene.scene);
  Simulation its_simulation(scene.scene, options.simulation);
  for (const auto& tool : own) tool->start(its_simulation);
  loosen_surfaces(its_simulation);
  return {std::move(scene), std::move(its_simulation)};
}

void PlayModel::open(Begun next) {
  if (simulation) before_own_edit("open");
  auto what = std::make_shared<LoadedScene>(LoadedScene{std::move(next.scene), next.simulation.snapshot()});
  enter(std::move(what), std::move(next.simulation));
  settings.gravity_x = gravity.x, settings.gravity_y = gravity.y, settings.gravity_z = gravity.z;
  settings.time_step = std::min(settings.time_step, play_scene().max_time_step);
  const model::Scene& scene = play_scene().scene.model();
  settings.cfl = is_projection(scene) ? scene.time.cfl : WorldSettings{}.cfl;
  choose_matter(*simulation, refusals, settings);
}

void PlayModel::enter(std::shared_ptr<const LoadedScene> what, Simulation its_simulation) {
  loaded = std::move(what);
  simulation.emplace(std::move(its_simulation));
  begin_anew<&PlayFieldUse::opens>(*this);
  foam.forget();
  gravity = play_scene().scene.model().gravity;
  no_other = why_not_other(play_scene());
  list_controls();
  arrivals.see(*simulation);
  losses.forget_stream(*simulation);
}

void PlayModel::restart() {
  // Materials stay as they are set.
  std::map<std::string, double> values;
  for (const ControlInfo& c : *controls)
    if (material_key(c.id) && !look_member(looks, c.id))
      values[c.id] = targets.contains(c.id) ? targets[c.id] : control_value(c, *this, *simulation);
  simulation->restore(loaded->start);
  list_controls();
  begin_anew<&PlayFieldUse::jumps>(*this);
  for (const ControlInfo& c : *controls) {
    const auto value = values.find(c.id);
    if (value != values.end() && value->second != control_value(c, *this, *simulation))
      set_parameter(*simulation, c.id, value->second);
  }
  clock.restart_is_due = false;
  end_tools();
}

void PlayModel::end_tools() {
  begin_anew<&PlayFieldUse::ends>(*this);
  // The snapshot may be of a moment at which a tool worked.
  for (const auto& tool : tools) tool->reset(*this);
  arrivals.jump(*simulation);
  foam.forget();
  gravity = simulation->scene().model().gravity;
  losses.forget_stream(*simulation);
}

void PlayModel::go_to(const StateSnapshot& moment) {
  const auto& [its_scene, snapshot, world, played] = moment;
  if (its_scene != loaded) enter(its_scene, Simulation(its_scene->scene.scene, options.simulation));
  simulation->restore(snapshot);
  // How the world is seen and worked on is not undone.
  static_cast<WorldSettings&>(settings) = world;
  clock.played = played;
  begin_anew<&PlayFieldUse::jumps>(*this);
  end_tools();
  list_controls();
}

void PlayModel::apply_settings_and_tools(double seconds) {
  Vec3d wanted{settings.gravity_x, settings.gravity_y, settings.gravity_z};
  for (const auto& tool : tools) wanted += tool->acceleration();
  if (!(wanted == gravity)) simulation->set_gravity(gravity = wanted);
  if (const model::Time& time = simulation->scene().model().time;
      time.solver == SolverKind::projection && time.cfl != settings.cfl)
    simulation->set_cfl(settings.cfl);
  for (const auto& tool : tools) tool->tick(*this, seconds);
}

double PlayModel::asked_seconds() const {
  return settings.speed * (play_scene().report ? report_substeps * settings.time_step * 1e-4 : 1 / ticks_a_second);
}

int PlayModel::advance(const Playground::Limit& limit) {
  const auto began = std::chrono::steady_clock::now();
  const double from = simulation->time(), asked = asked_seconds();
  // Of a pace below a step a tick, whole steps are saved up for. A side that stands still since the
  // other does has nothing pending.
  if (limit.simulated)
    clock.pending += *limit.simulated;
  else if (!limit.steps || *limit.steps > 0)
    clock.pending = std::min(clock.pending + asked, std::max(2 * asked, simulation->dt()));
  int taken = 0;
  bool gave_way = false;
  const auto steps = [&](int count) {
    const auto at = std::chrono::steady_clock::now();
    const double before = simulation->time();
    // The force on a wall is the mean over the tick, in however many calls it is done.
    const StepReport last = simulation->advance_steps(count, taken > 0 ? ForceMean::goes_on : ForceMean::of_this_call);
    cost.latest = 0.5 * (cost.latest + seconds_since(at) / count);
    clock.pending -= last.time - before;
    meters.taken_dt = last.dt;
    // The last step of a frame ends with it; what limited those before says more.
    if (last.limiter != "frame" || meters.limiter.empty()) meters.limiter = last.limiter;
    taken += count;
  };
  if (limit.steps) {
    if (*limit.steps > 0) steps(*limit.steps);
  } else {
    bool in_time = true;
    while (in_time && clock.pending > 0.5 * simulation->dt()) {
      if (taken > 0 && limit.gives_way && (gave_way = limit.gives_way())) break;
      int count = std::max(1, static_cast<int>(std::lround(clock.pending / simulation->dt())));
      if (limit.seconds) {
        const double left = *limit.seconds - seconds_since(began);
        in_time = taken == 0 || (left > 0 && !(limit.ends && limit.ends(*limit.seconds - left)));
        if (!in_time) break;
        const bool is_asked = limit.ends || limit.gives_way;
        count = std::clamp(static_cast<int>((is_asked ? std::min(left, ask_every) : left) / cost.latest), 1, count);
      }
      steps(count);
    }
    if (!in_time) clock.pending = std::min(clock.pending, 0.0);  // what could not be done in time is left out
  }
  if (taken > 0) {
    const double each = seconds_since(began) / taken;
    cost.mean += (cost.mean > 0 ? 1 / ticks_a_second : 1) * (each - cost.mean);
  }
  meters.substeps = taken, meters.remedy = remedy(*simulation, meters.limiter);
  meters.step_ms = 1e3 * cost.latest;
  meters.asked_dt = play_scene().report ? settings.time_step * 1e-4 : asked / std::max(taken, 1);
  // A tick that gave way says nothing about the pace.
  if (!gave_way) meters.rate = asked > 0 ? std::min((simulation->time() - from) / asked, 1.0) : 1;
  // A step that is longer than the tick may be has held up those to come.
  if (const double took = seconds_since(began); !gave_way && limit.seconds && took > *limit.seconds)
    meters.rate *= std::min(1.0, 1 / (ticks_a_second * took));
  return taken;
}

void PlayModel::jump(Jump where, const std::string& why) {
  const StateSnapshot* before = where == Jump::back ? history.latest() : nullptr;
  if (before)
    go_to(*before);
  else
    restart();
  clock.last_jump = before ? Jump::back : Jump::anew;
  say(fmt::format("{}: {}", before ? "went back a moment" : "began anew", why), true);
}

int PlayModel::fail(std::uint64_t before_steps, const std::string& why) {
  // Counts the step that failed: a tick of this number of steps fails again.
  const int taken = static_cast<int>(simulation->steps() - before_steps) + 1;
  // Nothing breaks it: what was before goes on, without what the tool did.
  jump(++clock.failures < most_failures ? Jump::back : Jump::anew, why);
  return taken;
}

int PlayModel::tick(const Playground::Limit& limit) {
  ++clock.ticks;
  clock.last_jump = Jump::none;
  if (clock.restart_is_due) restart();
  // A counted tick of no steps is one that stood still when it was recorded.
  if (settings.paused && !clock.single_step && !limit.simulated && limit.steps.value_or(0) == 0) {
    meters.substeps = 0;
    return 0;
  }
  const double seconds = asked_seconds();
  const std::uint64_t before_steps = simulation->steps();
  int taken = 0;
  try {
    approach_targets();
    apply_settings_and_tools(seconds);
    const bool single = std::exchange(clock.single_step, false);
    taken = advance(single && !limit.simulated ? Playground::Limit{1, {}} : limit);
    clock.failures = 0;
  } catch (const NumericalFailure& e) {
    taken = fail(before_steps, e.what());
  } catch (const InputError& e) {
    // What the tool or a slider asked for does not go with the scene.
    taken = fail(before_steps, e.what());
  }
  arrivals.see(*simulation);
  if (settings.foam)
    foam.see(*simulation);
  else
    foam.forget();
  say_losses();
  clock.played += 1 / ticks_a_second;
  if (history.is_due(clock.played)) history.keep(moment());
  return taken;
}

void PlayModel::say_losses() {
  losses.count(*simulation, clock.played);
  if (!losses.has_news) return;
  const bool goes_on = !losses.message.empty() && message.text == losses.message;
  if (!goes_on && !losses.may_begin(clock.played)) return;
  losses.message = fmt::format("{}: {}", lost_text(losses.stream), history.can_undo() ? "Undo" : "Rewind");
  losses.has_news = false;
  if (goes_on)
    message.text = losses.message, ++message.changes;
  else
    say(losses.message), losses.began = clock.played;
}

void PlayModel::approach_targets() {
  // Of the report: the deformation is forgotten, places and velocities are kept.
  const bool forgets = play_scene().report && !settings.auto_restart;
  for (const std::string& material : play::approach_targets(*simulation, *controls, looks, targets))
    if (forgets) simulation->reset_state(material);
}

void PlayModel::list_controls() {
  controls = std::make_shared<const std::vector<ControlInfo>>(play::list_controls(play_scene(), *simulation, looks));
  refusals = matter_refusals(simulation->scene().model());
}

void PlayModel::set(const std::string& id, double value) {
  const ControlInfo& control = find_control(*controls, id);
  check_value(control, value);
  const auto warn_of_softness = [&](const std::vector<double>& before) {
    std::string warning = softness_warning(*simulation, *controls, before, asked_values(*controls, *this, *simulation));
    if (!warning.empty()) say(std::move(warning));
  };
  for (const SettingControl& c : setting_controls()) {
    if (c.info.id != id) continue;
    // A tilt sets all of gravity: one edit.
    if (c.of_world) before_edit("set " + id.substr(0, id.find('.')));
    const std::vector<double> before = asked_values(*controls, *this, *simulation);
    c.set(settings, value);
    if (c.of_world) warn_of_softness(before);
    return;
  }
  if (float* member = look_member(looks, id)) {
    *member = static_cast<float>(value);
    return;
  }
  if (value == control_value(control, *this, *simulation) && !targets.contains(id)) return;
  before_edit("set " + id);
  const std::vector<double> before = asked_values(*controls, *this, *simulation);
  targets[id] = value;
  if (is_of_firmness(material_key(id)->key)) warn_of_softness(before);
  if (play_scene().report && settings.auto_restart) clock.restart_is_due = true;
}

void PlayModel::set_report_look(const ReportLook& look) {
  const std::string name = report_material_name(diy_material);
  const auto has = [&](const ControlInfo& c) { return c.id == material_control_id(name, "v"); };
  if (!play_scene().report || std::none_of(controls->begin(), controls->end(), has))
    throw InputError("look: only the report's scenes have its material; open report 1");
  // Whatever it sets.
  before_own_edit("look");
  for (const auto& [key, value] : look.values()) targets[material_control_id(name, key)] = value;
  if (settings.auto_restart) clock.restart_is_due = true;
}

std::string PlayModel::ensure_matter(std::size_t kind) {
  if (const auto& own = compared.replacement;
      own && matters()[kind].name == compared.replaced && !other_liquid(simulation->scene().model(), *own))
    kind = *own;
  const Matter& matter = matters()[kind];
  const std::vector<std::string> names = simulation->scene().materials();
  if (std::find(names.begin(), names.end(), matter.name) != names.end()) return std::string(matter.name);
  if (!refusals[kind].empty())
    throw InputError(fmt::format("{}: {}; the other solver can (key {})", matter.title, refusals[kind], solver_key));
  const model::Scene& kinds = scene_of_kinds();
  simulation->add_material(kinds.materials.at(kind), kinds.render.looks.at(std::string(matter.name)));
  list_controls();
  return std::string(matter.name);
}

}  // namespace dreampm::play
