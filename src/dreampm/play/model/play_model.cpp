#include "dreampm/play/model/play_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "dreampm/base/seconds_since.h"
#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/solver_choice.h"

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
      simulation.set_slack(name, std::max(c.slack, slack_of_moving));
}

}  // namespace

PlayModel::PlayModel(PlayScene first, const PlayOptions& o) : options(o), history(o.history_bytes) {
  open(begin(std::move(first)));
}

PlayModel::Begun PlayModel::begin(PlayScene scene) const {
  ToolSet own;
  for (const auto& tool : own) tool->take(scene.scene);
  Simulation fresh(scene.scene, options.simulation);
  for (const auto& tool : own) tool->put(fresh);
  loosen_surfaces(fresh);
  return {std::move(scene), std::move(fresh)};
}

void PlayModel::open(Begun next) {
  if (simulation) before_own_edit("open");
  auto what = std::make_shared<LoadedScene>(LoadedScene{std::move(next.scene), next.simulation.snapshot()});
  enter(std::move(what), std::move(next.simulation));
  settings.gravity_x = gravity.x, settings.gravity_y = gravity.y, settings.gravity_z = gravity.z;
  settings.time_step = std::min(settings.time_step, play_scene().max_time_step);
  const model::Scene& scene = play_scene().scene.model();
  settings.cfl = is_projection(scene) ? scene.time.cfl : WorldSettings{}.cfl;
  choose_matter();
}

void PlayModel::enter(std::shared_ptr<const LoadedScene> what, Simulation fresh) {
  loaded = std::move(what);
  simulation.emplace(std::move(fresh));
  begin_anew<&PlayFieldUse::opens>(*this);
  bodies.clear();
  gravity = play_scene().scene.model().gravity;
  no_other = why_not_other(play_scene());
  list_controls();
  see_new_matter();
  forget_losses();
}

void PlayModel::restart() {
  // Materials stay as they are set.
  std::map<std::string, double> values;
  for (const ControlInfo& c : *controls)
    if (c.id.starts_with("material.") && !look_member(c.id))
      values[c.id] = targets.contains(c.id) ? targets[c.id] : value_of(c);
  simulation->restore(loaded->start);
  list_controls();
  begin_anew<&PlayFieldUse::jumps>(*this);
  for (const ControlInfo& c : *controls) {
    const auto value = values.find(c.id);
    if (value != values.end() && value->second != value_of(c)) set_material(c.id, value->second);
  }
  clock.restart_is_due = false;
  end_tools();
}

void PlayModel::end_tools() {
  begin_anew<&PlayFieldUse::ends>(*this);
  // The snapshot may be of a moment at which a tool worked.
  for (const auto& tool : tools) tool->reset(*this);
  arrivals.ages.back_to(simulation->time()), arrivals.seen_until.reset();
  gravity = simulation->scene().model().gravity;
  forget_losses();
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
  // other does owes nothing.
  if (limit.simulated)
    clock.owed += *limit.simulated;
  else if (!limit.steps || *limit.steps > 0)
    clock.owed = std::min(clock.owed + asked, std::max(2 * asked, simulation->dt()));
  int taken = 0;
  bool gave_way = false;
  const auto steps = [&](int count) {
    const auto at = std::chrono::steady_clock::now();
    const double before = simulation->time();
    // The force on a wall is the mean over the tick, in however many calls it is done.
    const StepReport last = simulation->advance_steps(count, taken > 0 ? ForceMean::goes_on : ForceMean::of_this_call);
    cost.latest = 0.5 * (cost.latest + seconds_since(at) / count);
    clock.owed -= last.time - before;
    meters.taken_dt = last.dt;
    // The last step of a frame ends with it; what limited those before says more.
    if (last.limiter != "frame" || meters.limiter.empty()) meters.limiter = last.limiter;
    taken += count;
  };
  if (limit.steps) {
    if (*limit.steps > 0) steps(*limit.steps);
  } else {
    bool in_time = true;
    while (in_time && clock.owed > 0.5 * simulation->dt()) {
      if (taken > 0 && limit.gives_way && (gave_way = limit.gives_way())) break;
      int count = std::max(1, static_cast<int>(std::lround(clock.owed / simulation->dt())));
      if (limit.seconds) {
        const double left = *limit.seconds - seconds_since(began);
        in_time = taken == 0 || (left > 0 && !(limit.ends && limit.ends(*limit.seconds - left)));
        if (!in_time) break;
        const bool is_asked = limit.ends || limit.gives_way;
        count = std::clamp(static_cast<int>((is_asked ? std::min(left, ask_every) : left) / cost.latest), 1, count);
      }
      steps(count);
    }
    if (!in_time) clock.owed = std::min(clock.owed, 0.0);  // what could not be done in time is left out
  }
  if (taken > 0) {
    const double each = seconds_since(began) / taken;
    cost.mean += (cost.mean > 0 ? 1 / ticks_a_second : 1) * (each - cost.mean);
  }
  meters.substeps = taken, meters.remedy = remedy();
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
  clock.jumped = before ? Jump::back : Jump::anew;
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
  clock.jumped = Jump::none;
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
  see_new_matter();
  see_losses();
  clock.played += 1 / ticks_a_second;
  if (history.is_due(clock.played)) history.keep(moment());
  return taken;
}

std::shared_ptr<Frame> PlayModel::frame() {
  // One that nobody reads any more keeps its memory.
  auto idle = std::find_if(frames.begin(), frames.end(), [](const auto& f) { return f.use_count() == 1; });
  // What its last reader did comes before what is written into it.
  std::atomic_thread_fence(std::memory_order_acquire);
  if (idle == frames.end()) idle = frames.insert(idle, std::make_shared<Frame>());
  read(**idle);
  return *idle;
}

}  // namespace dreampm::play
