#include "dreampm/play/model/playground.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "dreampm/base/seconds_since.h"
#include "dreampm/error.h"
#include "dreampm/play/model/playground_impl.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/scene/description.h"

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

Playground::Impl::Impl(PlayScene first, const PlayOptions& o) : options(o), history(o.history_bytes) {
  open(begin(std::move(first)));
}

Playground::Impl::Begun Playground::Impl::begin(PlayScene stage) const {
  const auto held = take_pins(stage.scene);
  Simulation fresh(stage.scene, options.simulation);
  for (const auto& [name, stroke] : held) fresh.set_brush(name, stroke);
  loosen_surfaces(fresh);
  return {std::move(stage), std::move(fresh)};
}

void Playground::Impl::open(Begun next) {
  if (simulation) {
    history.separate();
    before_edit("open");
    history.separate();
  }
  auto what = std::make_shared<LoadedScene>(LoadedScene{std::move(next.stage), next.simulation.snapshot()});
  enter(std::move(what), std::move(next.simulation));
  settings.gravity_x = gravity.x, settings.gravity_y = gravity.y, settings.gravity_z = gravity.z;
  settings.time_step = std::min(settings.time_step, play_scene().max_time_step);
  settings.cfl =
      is_projection(play_scene().scene.description()) ? play_scene().scene.description().time.cfl : Settings{}.cfl;
  choose_matter();
}

void Playground::Impl::enter(std::shared_ptr<const LoadedScene> what, Simulation fresh) {
  opened = std::move(what);
  simulation.emplace(std::move(fresh));
  owed = 0;
  targets.clear(), grab.reset(), push.reset(), pour.reset(), bodies.clear(), looks.clear(), walls = {};
  restart_is_due = single_step = false, drops = failures = 0, shake = {};
  gravity = play_scene().scene.description().gravity;
  no_other = why_not_other(play_scene());
  list_controls();
  ages.forget(), seen_until.reset(), see_new_matter();
  losses = {}, forget_losses();
}

void Playground::Impl::restart() {
  // Materials stay as they are set.
  std::map<std::string, double> values;
  for (const ControlInfo& c : *controls)
    if (c.id.starts_with("material.") && !look_member(c.id))
      values[c.id] = targets.contains(c.id) ? targets[c.id] : value_of(c);
  simulation->restore(opened->start);
  list_controls();
  targets.clear();
  for (const ControlInfo& c : *controls) {
    const auto value = values.find(c.id);
    if (value != values.end() && value->second != value_of(c)) set_material(c.id, value->second);
  }
  restart_is_due = false;
  let_go();
}

void Playground::Impl::let_go() {
  // The snapshot may be of a moment at which a hand was there.
  simulation->lift_brush("push"), simulation->lift_brush("grab");
  simulation->let_go();
  ages.back_to(simulation->time()), seen_until.reset();
  grab.reset(), push.reset(), pour.reset(), shake = {}, owed = 0;
  stop_walls();
  gravity = simulation->scene().description().gravity;
  forget_losses();
}

void Playground::Impl::go_to(const StateSnapshot& moment) {
  if (moment.opened != opened) enter(moment.opened, Simulation(moment.opened->stage.scene, options.simulation));
  simulation->restore(moment.snapshot);
  // How the world is seen and worked on is not undone.
  for (const SettingControl& c : setting_controls())
    if (c.of_world) settings.*c.member = moment.settings.*c.member;
  played = moment.played;
  targets.clear();
  let_go();
  list_controls();
}

double Playground::Impl::asked_seconds() const {
  return settings.speed * (play_scene().report ? report_substeps * settings.time_step * 1e-4 : 1 / ticks_a_second);
}

int Playground::Impl::advance(const Limit& limit) {
  const auto began = std::chrono::steady_clock::now();
  const double from = simulation->time(), asked = asked_seconds();
  // Of a pace below a step a tick, whole steps are saved up for. A side that stands still since the
  // other does owes nothing.
  if (limit.simulated)
    owed += *limit.simulated;
  else if (!limit.steps || *limit.steps > 0)
    owed = std::min(owed + asked, std::max(2 * asked, simulation->dt()));
  int taken = 0;
  bool gave_way = false;
  const auto steps = [&](int count) {
    const auto at = std::chrono::steady_clock::now();
    const double before = simulation->time();
    // The force on a wall is the mean over the tick, in however many calls it is done.
    const StepReport last = simulation->advance_steps(count, taken > 0 ? ForceMean::goes_on : ForceMean::of_this_call);
    step_seconds = 0.5 * (step_seconds + seconds_since(at) / count);
    owed -= last.time - before;
    meters.taken_dt = last.dt;
    // The last step of a frame ends with it; what limited those before says more.
    if (last.limiter != "frame" || meters.limiter.empty()) meters.limiter = last.limiter;
    taken += count;
  };
  if (limit.steps) {
    if (*limit.steps > 0) steps(*limit.steps);
  } else {
    bool in_time = true;
    while (in_time && owed > 0.5 * simulation->dt()) {
      if (taken > 0 && limit.gives_way && (gave_way = limit.gives_way())) break;
      int count = std::max(1, static_cast<int>(std::lround(owed / simulation->dt())));
      if (limit.seconds) {
        const double left = *limit.seconds - seconds_since(began);
        in_time = taken == 0 || (left > 0 && !(limit.ends && limit.ends(*limit.seconds - left)));
        if (!in_time) break;
        const bool is_asked = limit.ends || limit.gives_way;
        count = std::clamp(static_cast<int>((is_asked ? std::min(left, ask_every) : left) / step_seconds), 1, count);
      }
      steps(count);
    }
    if (!in_time) owed = std::min(owed, 0.0);  // what could not be done in time is left out
  }
  if (taken > 0) {
    const double each = seconds_since(began) / taken;
    mean_step_seconds += (mean_step_seconds > 0 ? 1 / ticks_a_second : 1) * (each - mean_step_seconds);
  }
  meters.substeps = taken, meters.remedy = remedy();
  meters.step_ms = 1e3 * step_seconds;
  meters.asked_dt = play_scene().report ? settings.time_step * 1e-4 : asked / std::max(taken, 1);
  // A tick that gave way says nothing about the pace.
  if (!gave_way) meters.rate = asked > 0 ? std::min((simulation->time() - from) / asked, 1.0) : 1;
  // A step that is longer than the tick may be has held up those to come.
  if (const double took = seconds_since(began); !gave_way && limit.seconds && took > *limit.seconds)
    meters.rate *= std::min(1.0, 1 / (ticks_a_second * took));
  return taken;
}

Playground::Playground(PlayScene stage, const PlayOptions& options)
    : impl_(std::make_unique<Impl>(std::move(stage), options)) {}
Playground::~Playground() = default;

void Playground::Impl::jump(Jump where, const std::string& why) {
  const StateSnapshot* before = where == Jump::back ? history.latest() : nullptr;
  if (before)
    go_to(*before);
  else
    restart();
  jumped = before ? Jump::back : Jump::anew;
  say(fmt::format("{}: {}", before ? "went back a moment" : "began anew", why), true);
}

int Playground::Impl::fail(std::uint64_t before_steps, const std::string& why) {
  // Counts the step that failed: a tick of this number of steps fails again.
  const int taken = static_cast<int>(simulation->steps() - before_steps) + 1;
  // Nothing breaks it: what was before goes on, without what the hand did.
  jump(++failures < most_failures ? Jump::back : Jump::anew, why);
  return taken;
}

int Playground::Impl::tick(const Limit& limit) {
  ++ticks;
  jumped = Jump::none;
  if (restart_is_due) restart();
  // A counted tick of no steps is one that stood still when it was recorded.
  if (settings.paused != 0 && !single_step && !limit.simulated && limit.steps.value_or(0) == 0) {
    meters.substeps = 0;
    return 0;
  }
  const double seconds = asked_seconds();
  const std::uint64_t before_steps = simulation->steps();
  int taken = 0;
  try {
    approach_targets();
    apply_hand(seconds);
    const bool single = std::exchange(single_step, false);
    taken = advance(single && !limit.simulated ? Limit{1, {}} : limit);
    failures = 0;
  } catch (const NumericalFailure& e) {
    taken = fail(before_steps, e.what());
  } catch (const InputError& e) {
    // What the hand or a slider asked for does not go with the scene.
    taken = fail(before_steps, e.what());
  }
  see_new_matter();
  see_losses();
  played += 1 / ticks_a_second;
  if (history.is_due(played)) history.keep(moment());
  return taken;
}

void Playground::act(const Action& action) {
  ++impl_->actions;
  const auto entry = std::find_if(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == action.verb; });
  if (entry == verbs().end()) {
    std::string names;
    for (const Verb& v : verbs()) names += fmt::format("{}{}", names.empty() ? "" : ", ", v.name);
    throw InputError(fmt::format("no verb '{}'; there are {}", action.verb, names));
  }
  try {
    if (entry->run_whole)
      entry->run_whole(*this, action);
    else if (second_)
      act_on_both(*entry, action);
    else
      entry->run(*impl_, action);
  } catch (const Error& e) {
    chosen().say(e.what(), true);
    share_message();
    throw;
  }
  share_message();
}

std::shared_ptr<Frame> Playground::Impl::frame() {
  // One that nobody reads any more keeps its memory.
  auto idle = std::find_if(frames.begin(), frames.end(), [](const auto& f) { return f.use_count() == 1; });
  // What its last reader did comes before what is written into it.
  std::atomic_thread_fence(std::memory_order_acquire);
  if (idle == frames.end()) idle = frames.insert(idle, std::make_shared<Frame>());
  read(**idle);
  return *idle;
}

void Playground::tell(const std::string& what, bool is_error) {
  chosen().say(what, is_error);
  share_message();
}
bool Playground::is_filmed() const { return !impl_->films->file.empty(); }
int Playground::threads() const { return impl_->simulation->threads(); }
std::string Playground::isa() const { return impl_->simulation->isa(); }
const Simulation& Playground::simulation() const { return *impl_->simulation; }

}  // namespace dreampm::play
