// What scripts and tools can do, one entry a verb; those of tools stand with the tools.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "dreampm/base/file.h"
#include "dreampm/error.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/play_model.h"
#include "dreampm/play/model/save.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/report/report_looks.h"
#include "dreampm/play/tools/arguments.h"

namespace dreampm::play {
namespace {

void can_undo(const PlayModel& p) {
  if (!p.history.can_undo()) throw InputError("undo: there is nothing to undo");
}
void can_redo(const PlayModel& p) {
  if (!p.history.can_redo()) throw InputError("redo: there is nothing to redo");
}

bool always(const Action&) { return true; }
bool is_of_material(const Action& a) { return !a.words.empty() && a.words[0].starts_with("material."); }

void open(Playground& playground, const Action& a) {
  // As the command's --preset has it: from 1.
  const int preset = a.words.size() > 1 ? a.whole(1, 1000) : 1;
  if (preset < 1) throw InputError("open: presets count from 1");
  playground.open(load_play_scene(a.word(0), static_cast<std::size_t>(preset - 1)));
}

void size(Playground& playground, const Action& a) {
  const auto name = std::find(size_names().begin(), size_names().end(), a.word(0));
  if (name == size_names().end())
    throw InputError(fmt::format("size: no size '{}'; there are {}", a.word(0), fmt::join(size_names(), ", ")));
  playground.resize(static_cast<std::size_t>(name - size_names().begin()));
}

void solver(Playground& playground, const Action& a) {
  const auto name = std::find(solver_names().begin(), solver_names().end(), a.word(0));
  if (name == solver_names().end())
    throw InputError(fmt::format("solver: no solver '{}'; there are {}", a.word(0), fmt::join(solver_names(), ", ")));
  playground.choose_solver(static_cast<SolverKind>(name - solver_names().begin()));
}

void compare(Playground& playground, const Action& a) {
  const std::string& what = a.word(0);
  if (what == "off") return playground.end_comparison();
  if (what == "side") {
    if (const std::string& side = a.word(1); side != "A" && side != "B")
      throw InputError(fmt::format("compare: there are sides A and B, and no {}", side));
    return playground.choose_side(a.word(1) == "B");
  }
  if (what != "on") throw InputError(fmt::format("compare: on, side or off, and not {}", what));
  if (a.words.size() == 1) return playground.compare(std::nullopt);
  std::string names;
  for (std::size_t kind = 0; kind < matters().size(); ++kind) {
    if (matters()[kind].name == a.word(1)) return playground.compare(kind);
    names += fmt::format("{} {}", kind == 0 ? "" : ",", matters()[kind].name);
  }
  throw InputError(fmt::format("compare: no matter '{}'; there are{}", a.word(1), names));
}

/// Of the side, without what tools add to gravity.
void save(const PlayModel& p, const std::filesystem::path& file, const SavedAs& as) {
  const Vec3d gravity{p.settings.gravity_x, p.settings.gravity_y, p.settings.gravity_z};
  save_scene(file, as, *p.simulation, gravity, p.tools);
}

/// Saves a finer scene and begins an estimate of its film, or the film itself.
void make_film(PlayModel& p, const Action& a, bool goes_on) {
  if (p.options.program.empty()) throw InputError(a.verb + ": no command dreampm that could make a film is known");
  std::optional<Rendering>& rendering = p.films->rendering;
  if (rendering && rendering->look().state == RenderStatus::State::running)
    throw InputError(a.verb + ": a film is under way; render off ends it");
  const SavedAs as = finer_scene(a);
  rendering.reset();  // an estimate that was there takes its files along
  save(p, a.word(0), as);
  rendering.emplace(p.options.program, a.word(0), p.simulation->backend(), goes_on);
}

void render_or_end(PlayModel& p, const Action& a) {
  const bool off = is_off(a), leave = a.words.size() == 1 && a.words[0] == "leave";
  if (!off && !leave) return make_film(p, a, true);
  std::optional<Rendering>& rendering = p.films->rendering;
  if (!rendering) throw InputError("render: there is no film under way");
  if (off)
    rendering->stop();
  else
    rendering->leave();
}

void film(PlayModel& p, const Action& a) {
  if (is_off(a)) return p.films->file.clear();
  const std::filesystem::path file = a.word(0);
  if (file.extension() != ".mp4") throw InputError(fmt::format("film: {} must end in .mp4", file.string()));
  const int fps = a.words.size() > 1 ? a.whole(1, 60) : 60;
  if (fps != 30 && fps != 60) throw InputError(fmt::format("film: {} frames a second; 30 and 60 work", fps));
  if (!p.films->file.empty())
    throw InputError(fmt::format("film: {} is being filmed; film off ends it", p.films->file));
  if (!file.parent_path().empty()) make_folder(file.parent_path());
  check_replaceable(file);
  p.films->file = file.string(), p.films->fps = fps;
}

void seek(PlayModel& p, const Action& a) {
  const StateSnapshot* moment = p.history.seek(p.history.last() - a.number(0));
  if (!moment) throw InputError("seek: there is no past yet");
  p.go_to(*moment);
}

void undo(PlayModel& p, const Action&) {
  can_undo(p);
  p.go_to(p.history.undo(p.moment()));
}

void redo(PlayModel& p, const Action&) {
  can_redo(p);
  p.go_to(p.history.redo(p.moment()));
}

void restart(PlayModel& p, const Action&) {
  p.before_own_edit("restart");
  p.restart();
}

std::vector<Verb> verbs_of_time_and_matter() {
  return {
      {"open", "NAME [PRESET]", "another story, scene file or config of the report, with its presets counted from 1",
       nullptr, open},
      {"size", "small | medium | large", "begins anew with fewer or more particles; so do stories that are opened then",
       nullptr, size},
      {"solver", "explicit | projection",
       "begins anew by that solver: short steps of all matter, or large ones of liquids and what lies in them", nullptr,
       solver},
      {"compare", "on [MATTER] | side A | side B | off",
       "a second side beside the first, with that matter in place of the main one; which side sliders set; one side",
       nullptr, compare},
      {"restart", "", "begins anew, with the materials as they are set", restart},
      Verb{"set", "CONTROL VALUE", "a setting of the panel, by its name in scripts",
           [](PlayModel& p, const Action& a) { p.set(a.word(0), a.number(1)); }}
          .on_one_side(is_of_material),
      Verb{"look", "NAME", "a look of the report's material, as liquid, honey, stone or elastic, in its scenes",
           [](PlayModel& p, const Action& a) { p.set_report_look(report_look(a.word(0))); }}
          .on_one_side(always),
      {"step", "", "a single step", [](PlayModel& p, const Action&) { p.clock.single_step = true; }},
      Verb{"undo", "", "takes the last edit back", undo}.checked_by(can_undo),
      Verb{"redo", "", "does again what was taken back", redo}.checked_by(can_redo),
      {"seek", "SECONDS", "goes to the moment that many seconds before the latest one", seek},
      Verb{"done", "", "ends an edit: what is set next is taken back by itself",
           [](PlayModel& p, const Action&) { p.history.separate(); }}
          .by_passing(),
  };
}

std::vector<Verb> verbs_of_files() {
  return {
      Verb{"save", "FILE.yaml", "writes a scene that `dreampm make` runs, with the particles beside it",
           [](PlayModel& p, const Action& a) {
             save(p, a.word(0), {});
             p.say(fmt::format("saved {}: dreampm make runs it", std::filesystem::absolute(a.word(0)).string()));
           }}
          .on_one_side(always),
      Verb{"estimate", "FILE.yaml [SECONDS [FROM TO FOV]]",
           "saves a scene of 8 times the particles, and says what its film will take",
           [](PlayModel& p, const Action& a) { make_film(p, a, false); }}
          .unrecorded()
          .on_one_side(always),
      Verb{"render", "FILE.yaml [SECONDS [FROM TO FOV]] | off | leave",
           "saves a scene of 8 times the particles, and makes its film in the background; off: stops it, dreampm make "
           "goes on with it, and of an estimate nothing stays; leave: it outlives this program",
           render_or_end}
          .unrecorded()
          .on_one_side(always),
      Verb{"film", "FILE.mp4 [30 | 60] | off", "films the picture, at 60 frames a second unless said otherwise", film}
          .unrecorded()
          .on_one_side(always),
  };
}

/// With a button, or without.
void add_those_of_tools(bool with_button, std::vector<Verb>& all) {
  for (const ToolInfo& tool : tool_infos())
    if ((tool.key != 0) == with_button) all.insert(all.end(), tool.verbs.begin(), tool.verbs.end());
}

}  // namespace

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = [] {
    std::vector<Verb> list = verbs_of_time_and_matter();
    add_those_of_tools(true, list);
    for (const Verb& verb : verbs_of_files()) list.push_back(verb);
    add_those_of_tools(false, list);
    return list;
  }();
  return all;
}

}  // namespace dreampm::play
