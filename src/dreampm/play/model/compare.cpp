// A and B: the same stage twice, with the same hands and different materials.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>

#include "dreampm/base/hash.h"
#include "dreampm/error.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/playground_impl.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/scene/description.h"

namespace dreampm::play {

std::string Playground::Impl::main_material() const {
  std::string name;
  std::size_t most = 0;
  const scene::SceneDescription& scene = simulation->scene().description();
  // Where all matter is still to come, that of the first emitter.
  if (!scene.emitters.empty())
    name = scene.materials.at(static_cast<std::size_t>(scene.emitters.front().material)).name;
  for (const scene::Material& m : scene.materials) {
    const std::size_t count = simulation->particle_count(m.name);
    if (name.empty() || count > most) name = m.name, most = count;
  }
  return name;
}

void Playground::Impl::choose_matter() {
  const std::string name = main_material();
  for (const scene::Material& m : simulation->scene().description().materials) {
    if (m.name != name) continue;
    const auto kind = kind_of(m.name, m.info->name, m.values.has("viscosity") ? m.values["viscosity"] : 0);
    if (!kind) return;
    settings.matter = static_cast<double>(*kind);
    // The other kind, where the solver can do with it; else the same.
    const std::size_t other = compared_with(*kind);
    const bool is_there = refusals[other].empty() || other_liquid(simulation->scene().description(), other);
    settings.compare_with = is_there ? static_cast<double>(other + 1) : 0;
  }
}

void Playground::Impl::put_stand_in() {
  if (!stand_in) return;
  if (const auto liquid = other_liquid(simulation->scene().description(), *stand_in)) {
    simulation->set_parameter(stand_in_for, "density", liquid->density);
    simulation->set_parameter(stand_in_for, "viscosity", liquid->viscosity);
    looks.insert_or_assign(stand_in_for, look_of(liquid->look));
    return list_controls();
  }
  if (const std::string name = ensure_matter(*stand_in); name != stand_in_for) simulation->convert(stand_in_for, name);
}

void Playground::Impl::copy(const Impl& other, std::optional<std::size_t> kind) {
  settings = other.settings;
  main = stand_in_for = other.main;
  stand_in = kind;
  if (kind) main = matters()[*kind].name;
  // A simulation of the same scene takes snapshots of the other.
  simulation->restore(other.opened->start);
  looks = other.looks;
  list_controls();
  put_stand_in();
  opened = std::make_shared<LoadedScene>(LoadedScene{other.play_scene(), simulation->snapshot()});
  simulation->restore(other.simulation->snapshot());
  list_controls();
  put_stand_in();
  targets.clear();
  for (const auto& [id, value] : other.targets)
    if (std::any_of(controls->begin(), controls->end(), [&, &name = id](const ControlInfo& c) { return c.id == name; }))
      targets[id] = value;
  drops = other.drops, played = other.played, films = other.films;
  message = other.message, message_is_error = other.message_is_error, message_number = other.message_number;
  history.forget();
  let_go();
}

void Playground::compare(std::optional<std::size_t> kind) {
  Impl& first = *impl_;
  first.main = first.main_material();
  PlayOptions options = first.options;
  auto second = std::make_unique<Impl>(first.play_scene(), options);
  second->copy(first, kind);
  // All three share the memory that one had.
  History past = second_ ? std::move(*before_comparison_) : std::move(first.history);
  before_comparison_.reset();
  options.history_bytes = first.options.history_bytes / 3;
  past.limit(options.history_bytes), past.separate();
  first.history = History(options.history_bytes), second->history = History(options.history_bytes);
  before_comparison_ = std::move(past);
  first.let_go();
  second_ = std::move(second);
  second_is_chosen_ = false;
  compared_kind_ = kind;
}

void Playground::choose_side(bool second) {
  if (!second_) throw InputError("compare: there is one side; `compare on` starts the other");
  second_is_chosen_ = second;
}

void Playground::end_comparison() {
  if (!second_) throw InputError("compare: nothing is compared");
  second_.reset();
  second_is_chosen_ = false;
  impl_->history = std::move(*before_comparison_);
  before_comparison_.reset();
  impl_->history.limit(impl_->options.history_bytes);
}

void Playground::open(PlayScene stage) {
  if (size_ && !stage.report && stage.scene.description().start.empty()) stage = resized(std::move(stage), *size_);
  Impl::Begun next = impl_->begin(std::move(stage));  // where it throws, nothing has changed
  if (!second_) return impl_->open(std::move(next));
  // The comparison is of the new stage; what was before it is as it was left.
  const auto kind = compared_kind_;
  end_comparison();
  impl_->open(std::move(next));
  compare(kind);
}

void Playground::act_on_both(const Verb& verb, const Action& action) {
  Impl* const sides[] = {impl_.get(), second_.get()};
  // Of what memory holds no longer, one side may have more.
  if (verb.check)
    for (const Impl* side : sides) verb.check(*side);
  const bool of_one_side = verb.of_one_side && verb.of_one_side(action);
  std::uint64_t before[2];
  std::exception_ptr refused[2];
  bool any = false;
  for (int n = 0; n < 2; ++n) {
    before[n] = sides[n]->history.edits();
    if (of_one_side && sides[n] != &chosen()) continue;
    try {
      verb.run(*sides[n], action);
      any = true;
    } catch (const InputError& e) {
      refused[n] = std::current_exception();
      sides[n]->say(fmt::format("{}: {}", n == 0 ? "A" : "B", e.what()), true);
    }
  }
  if (!any) std::rethrow_exception(refused[0] ? refused[0] : refused[1]);
  // Both stay at the same time.
  impl_->restart_is_due = second_->restart_is_due = impl_->restart_is_due || second_->restart_is_due;
  // An edit of one side is one of the other too, which does not change it: undo takes both back to
  // the same moment.
  for (int n = 0; n < 2; ++n) {
    History& own = sides[n]->history;
    if (sides[1 - n]->history.edits() == before[1 - n] || own.edits() != before[n]) continue;
    own.separate();
    sides[n]->before_edit(sides[1 - n]->history.last_edit());
  }
}

void Playground::share_message() {
  if (!second_) return;
  Impl &a = *impl_, &b = *second_;
  Impl &newer = a.message_number < b.message_number ? b : a, &older = &newer == &a ? b : a;
  older.message = newer.message, older.message_is_error = newer.message_is_error,
  older.message_number = newer.message_number;
}

int Playground::tick(const Limit& limit) {
  Impl& first = *impl_;
  if (!second_) return first.tick(limit);
  Limit own = limit;
  if (limit.seconds) {
    // What the second side will take comes out of the same time.
    const double cost = first.step_seconds / first.simulation->dt(),
                 others = second_->step_seconds / second_->simulation->dt();
    own.seconds = *limit.seconds * cost / (cost + others);
  }
  const double from = first.simulation->time();
  const int taken = first.tick(own);
  const auto follow = [](Impl& to, const Impl& jumped) {
    if (jumped.jumped != Impl::Jump::none && to.jumped == Impl::Jump::none)
      to.jump(jumped.jumped, "so did the other side");
  };
  if (first.jumped != Impl::Jump::none) {
    follow(*second_, first);
    second_->played = first.played;
  } else if (taken == 0) {
    second_->tick({0, {}});
  } else {
    second_->tick({{}, {}, first.simulation->time() - from});
    follow(first, *second_);
    first.played = second_->played;
  }
  share_message();
  return taken;
}

std::shared_ptr<const Frame> Playground::frame() {
  const std::shared_ptr<Frame> own = chosen().frame();
  own->actions = impl_->actions;
  own->side = 0, own->other.reset();
  if (!second_) return own;
  const bool is_second = &chosen() == second_.get();
  const std::shared_ptr<Frame> other = (is_second ? *impl_ : *second_).frame();
  other->other.reset();
  own->side = is_second ? 'B' : 'A', other->side = is_second ? 'A' : 'B';
  own->side_name = chosen().main, other->side_name = is_second ? impl_->main : second_->main;
  // One scale for both.
  own->value_min = other->value_min = std::min(own->value_min, other->value_min);
  own->value_max = other->value_max = std::max(own->value_max, other->value_max);
  own->other = other;
  return own;
}

std::uint64_t Playground::hash() const {
  const std::uint64_t first = impl_->simulation->hash();
  if (!second_) return first;
  Hash64 both;
  both.add(first), both.add(second_->simulation->hash());
  return both.value();
}

const Simulation* Playground::second_simulation() const { return second_ ? &*second_->simulation : nullptr; }

}  // namespace dreampm::play
