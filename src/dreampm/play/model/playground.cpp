#include "dreampm/play/model/playground.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "dreampm/base/hash.h"
#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/compare.h"
#include "dreampm/play/model/play_model.h"

namespace dreampm::play {

Playground::Playground(PlayScene scene, const PlayOptions& options)
    : first_(std::make_unique<PlayModel>(std::move(scene), options)) {}
Playground::~Playground() = default;

PlayModel& Playground::chosen() const {
  return comparison_ && comparison_->second_is_chosen ? *comparison_->second : *first_;
}

void Playground::act(const Action& action) {
  ++actions_;
  const auto entry = std::find_if(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == action.verb; });
  if (entry == verbs().end()) {
    std::string names;
    for (const Verb& v : verbs()) names += fmt::format("{}{}", names.empty() ? "" : ", ", v.name);
    throw InputError(fmt::format("no verb '{}'; there are {}", action.verb, names));
  }
  try {
    if (entry->run_whole)
      entry->run_whole(*this, action);
    else if (comparison_)
      act_on_both(*entry, action);
    else
      entry->run(*first_, action);
  } catch (const Error& e) {
    chosen().say(e.what(), true);
    share_message();
    throw;
  }
  share_message();
}

void Playground::compare(std::optional<std::size_t> kind) {
  PlayModel& first = *first_;
  first.compared.main = main_material(*first.simulation);
  PlayOptions options = first.options;
  auto second = std::make_unique<PlayModel>(first.play_scene(), options);
  begin_second_side(*second, first, kind);
  // All three share the memory that one had.
  History past = comparison_ ? std::move(comparison_->before) : std::move(first.history);
  options.history_bytes = first.options.history_bytes / 3;
  past.limit(options.history_bytes), past.separate();
  first.history = History(options.history_bytes), second->history = History(options.history_bytes);
  first.end_tools();
  comparison_ = Comparison{std::move(second), std::move(past), kind};
}

void Playground::choose_side(bool second) {
  if (!comparison_) throw InputError("compare: there is one side; `compare on` starts the other");
  comparison_->second_is_chosen = second;
}

void Playground::end_comparison() {
  if (!comparison_) throw InputError("compare: nothing is compared");
  first_->history = std::move(comparison_->before);
  comparison_.reset();
  first_->history.limit(first_->options.history_bytes);
}

void Playground::open(PlayScene scene) {
  if (size_ && !scene.report && scene.scene.model().start.empty()) scene = resized(std::move(scene), *size_);
  PlayModel::Begun next = first_->begin(std::move(scene));  // where it throws, nothing has changed
  if (!comparison_) return first_->open(std::move(next));
  // The comparison is of the new scene; what was before it is as it was left.
  const auto kind = comparison_->kind;
  end_comparison();
  first_->open(std::move(next));
  try {
    compare(kind);
  } catch (const InputError& e) {
    // The scene is there, without what it was to be compared with.
    first_->say(fmt::format("{}; nothing is compared any more", e.what()), true);
  }
}

void Playground::act_on_both(const Verb& verb, const Action& action) {
  PlayModel* const sides[] = {first_.get(), comparison_->second.get()};
  // Of what memory holds no longer, one side may have more.
  if (verb.check)
    for (const PlayModel* side : sides) verb.check(*side);
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
  bool &one = sides[0]->clock.restart_is_due, &other = sides[1]->clock.restart_is_due;
  one = other = one || other;
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
  if (!comparison_) return;
  Message &a = first_->message, &b = comparison_->second->message;
  (a.is_older_than(b) ? a : b) = a.is_older_than(b) ? b : a;
}

int Playground::tick(const Limit& limit) {
  PlayModel& first = *first_;
  if (!comparison_) return first.tick(limit);
  PlayModel& second = *comparison_->second;
  Limit own = limit;
  if (limit.seconds) {
    // What the second side will take comes out of the same time.
    const double cost = first.cost.latest / first.simulation->dt(),
                 others = second.cost.latest / second.simulation->dt();
    own.seconds = *limit.seconds * cost / (cost + others);
  }
  const double from = first.simulation->time();
  const int taken = first.tick(own);
  const auto follow = [](PlayModel& to, const PlayModel& other) {
    if (other.clock.last_jump != Jump::none && to.clock.last_jump == Jump::none)
      to.jump(other.clock.last_jump, "so did the other side");
  };
  if (first.clock.last_jump != Jump::none) {
    follow(second, first);
    second.clock.played = first.clock.played;
  } else if (taken == 0) {
    second.tick({0, {}});
  } else {
    second.tick({{}, {}, first.simulation->time() - from});
    follow(first, second);
    first.clock.played = second.clock.played;
  }
  share_message();
  return taken;
}

std::shared_ptr<const Frame> Playground::frame() {
  const std::shared_ptr<Frame> own = chosen().frames.read(chosen());
  own->actions = actions_;
  own->side = 0, own->other.reset();
  if (!comparison_) return own;
  const bool is_second = comparison_->second_is_chosen;
  PlayModel& beside = is_second ? *first_ : *comparison_->second;
  const std::shared_ptr<Frame> other = beside.frames.read(beside);
  other->other.reset(), other->actions = actions_;
  own->side = is_second ? 'B' : 'A', other->side = is_second ? 'A' : 'B';
  own->side_name = chosen().compared.main, other->side_name = beside.compared.main;
  // One scale for both.
  own->value_min = other->value_min = std::min(own->value_min, other->value_min);
  own->value_max = other->value_max = std::max(own->value_max, other->value_max);
  own->other = other;
  return own;
}

std::uint64_t Playground::hash() const {
  const std::uint64_t first = first_->simulation->hash();
  if (!comparison_) return first;
  Hash64 both;
  both.add(first), both.add(comparison_->second->simulation->hash());
  return both.value();
}

const Simulation* Playground::second_simulation() const {
  return comparison_ ? &*comparison_->second->simulation : nullptr;
}

void Playground::tell(const std::string& what, bool is_error) {
  chosen().say(what, is_error);
  share_message();
}
bool Playground::is_filmed() const { return !first_->films->file.empty(); }
int Playground::threads() const { return first_->simulation->threads(); }
std::string Playground::backend() const {
  return fmt::format("{}, {}", first_->simulation->backend(), first_->simulation->isa());
}
const Simulation& Playground::simulation() const { return *first_->simulation; }

}  // namespace dreampm::play
