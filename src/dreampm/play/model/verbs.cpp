// What scripts and hands can do, one entry a verb.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "dreampm/base/file.h"
#include "dreampm/error.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/playground_impl.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/report/report_looks.h"
#include "dreampm/scene/description.h"

namespace dreampm::play {
namespace {

/// s of playing, from one push to the next of the same edit.
constexpr double same_push = 2;

Vec3d vector_at(const Action& a, std::size_t at) { return {a.number(at), a.number(at + 1), a.number(at + 2)}; }

/// What a cut took out: it parts matter by a gap, for what is nearer than a cell holds together.
std::string taken_text(std::size_t taken, std::size_t before) {
  if (taken == 0) return "cut: no matter was in its way";
  return fmt::format("cut: {} particle{} taken out for a gap, {:.2g} % of all: Undo", grouped(taken),
                     taken == 1 ? "" : "s", 100 * static_cast<double>(taken) / static_cast<double>(before));
}

double positive(const Action& a, std::size_t at) {
  const double value = a.number(at);
  if (!(value > 0)) throw InputError(a.verb + ": " + a.word(at) + " must be above 0");
  return value;
}

/// The size of the box: nobody means more by a length.
double box_size(const Playground::Impl& p) {
  const scene::Space& space = p.simulation->scene().description().space;
  return length(space.max - space.min);
}

/// A length of what is in a place. One beyond the box would be cells without end.
double size_at(const Playground::Impl& p, const Action& a, std::size_t at) {
  const double value = positive(a, at), most = box_size(p);
  if (value > most)
    throw InputError(fmt::format("{}: {} m is more than the box has, {:.4g} m", a.verb, a.word(at), most));
  return value;
}

/// A place in the box, or near it.
Vec3d place_at(const Playground::Impl& p, const Action& a, std::size_t at) {
  constexpr double near = 100;
  const scene::Space& space = p.simulation->scene().description().space;
  const Vec3d place = vector_at(a, at);
  if (!(length(place - (space.min + space.max) * 0.5) <= near * box_size(p)))
    throw InputError(fmt::format("{}: ({}, {}, {}) is far from the box", a.verb, place.x, place.y, place.z));
  return place;
}

bool is_off(const Action& a) { return a.words.size() == 1 && a.words[0] == "off"; }

void wall(Playground::Impl& p, const Action& a) {
  const scene::Space& space = p.simulation->scene().description().space;
  if (is_off(a)) {
    for (std::size_t side = 0; side < 6; ++side)
      if (p.has_slab(side)) p.draw_wall(side, (side % 2 ? space.max : space.min)[static_cast<int>(side) / 2]);
    return;
  }
  const auto name = std::find(scene::wall_names.begin(), scene::wall_names.end(), a.word(0));
  if (name == scene::wall_names.end())
    throw InputError(fmt::format("wall: no wall '{}'; there are {}", a.word(0), fmt::join(scene::wall_names, ", ")));
  p.draw_wall(static_cast<std::size_t>(name - scene::wall_names.begin()), a.number(1));
}

void can_undo(const Playground::Impl& p) {
  if (!p.history.can_undo()) throw InputError("undo: there is nothing to undo");
}
void can_redo(const Playground::Impl& p) {
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

}  // namespace

const std::vector<Verb>& verbs() {
  using Impl = Playground::Impl;
  static const std::vector<Verb> all{
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
      {"restart", "", "begins anew, with the materials as they are set",
       [](Impl& p, const Action&) {
         p.history.separate();
         p.before_edit("restart");
         p.history.separate();
         p.restart();
       }},
      Verb{"set", "CONTROL VALUE", "a setting of the panel, by its name in scripts",
           [](Impl& p, const Action& a) { p.set(a.word(0), a.number(1)); }}
          .on_one_side(is_of_material),
      Verb{"look", "NAME", "a look of the report's material, as liquid, honey, stone or elastic, in its scenes",
           [](Impl& p, const Action& a) { p.take_look(report_look(a.word(0))); }}
          .on_one_side(always),
      {"step", "", "a single step", [](Impl& p, const Action&) { p.single_step = true; }},
      Verb{"undo", "", "takes the last edit back",
           [](Impl& p, const Action&) {
             can_undo(p);
             p.go_to(p.history.undo(p.moment()));
           }}
          .checked_by(can_undo),
      Verb{"redo", "", "does again what was taken back",
           [](Impl& p, const Action&) {
             can_redo(p);
             p.go_to(p.history.redo(p.moment()));
           }}
          .checked_by(can_redo),
      {"seek", "SECONDS", "goes to the moment that many seconds before the latest one",
       [](Impl& p, const Action& a) {
         const StateSnapshot* moment = p.history.seek(p.history.last() - a.number(0));
         if (!moment) throw InputError("seek: there is no past yet");
         p.go_to(*moment);
       }},
      {"done", "", "ends an edit: what is set next is taken back by itself",
       [](Impl& p, const Action&) { p.history.separate(); }},
      {"push", "X Y Z RADIUS VX VY VZ",
       "matter and rigid bodies at that place are taken along at that velocity, until release",
       [](Impl& p, const Action& a) {
         const Push push{place_at(p, a, 0), vector_at(a, 4), size_at(p, a, 3)};
         // Strokes that follow one another are one edit.
         if (p.played > p.pushed + same_push) p.history.separate();
         p.before_edit("push");
         p.pushed = p.played;
         p.simulation->set_brush("push", {push.at, push.radius, push.velocity, push_rate * p.settings.strength});
         p.push = push;
       }},
      {"grab", "X Y Z RADIUS", "takes hold of the rigid body or the matter at that place, until release",
       [](Impl& p, const Action& a) {
         const Vec3d at = place_at(p, a, 0);
         const double radius = size_at(p, a, 3);
         p.before_edit("grab");
         p.simulation->let_go();
         p.take_hold(at, radius);
       }},
      {"pull", "X Y Z", "draws what is held to that place",
       [](Impl& p, const Action& a) {
         if (p.grab) p.grab->hand = place_at(p, a, 0);
       }},
      {"release", "", "ends push and grab",
       [](Impl& p, const Action&) {
         p.grab.reset(), p.push.reset();
         p.simulation->lift_brush("push"), p.simulation->lift_brush("grab");
         p.simulation->let_go();
         if (p.history.last_edit() != "push") p.history.separate();
       }},
      {"pour", "X Y Z RADIUS VX VY VZ | off", "a jet of the chosen matter, three spacings in radius at least",
       [](Impl& p, const Action& a) {
         if (is_off(a)) {
           p.pour.reset();
           return p.history.separate();
         }
         const Pour jet{place_at(p, a, 0), vector_at(a, 4), size_at(p, a, 3)};
         constexpr double fastest = 1000;  // m/s
         if (const double speed = length(jet.velocity); !(speed > 0 && speed <= fastest))
           throw InputError(fmt::format("pour: the velocity must be above 0, and {} m/s at most", fastest));
         p.before_edit("pour");
         if (p.pour)
           p.pour->at = jet.at, p.pour->velocity = jet.velocity, p.pour->radius = jet.radius;
         else
           p.pour = jet;
       }},
      {"drop", "SHAPE X Y Z SIZE",
       "a box, sphere, knot, dragon, or mesh from a file, of the chosen matter; or a rigid crate, brick or ball [m]",
       [](Impl& p, const Action& a) {
         const Vec3d at = place_at(p, a, 1);
         const double size = size_at(p, a, 4);
         p.history.separate();
         p.before_edit("drop");
         try {
           p.drop(a.word(0), at, size);
         } catch (const InputError&) {
           p.history.forget_edit();
           throw;
         }
       }},
      {"erase", "X Y Z RADIUS", "takes out the matter around, and the rigid body at that place",
       [](Impl& p, const Action& a) {
         const Vec3d at = place_at(p, a, 0);
         const double radius = std::min(positive(a, 3), box_size(p));  // which is all of it
         p.before_edit("erase");
         p.erase(at, radius);
       }},
      {"cut", "X Y Z NX NY NZ RADIUS", "takes out a thin disc of that normal: what it went through is in two",
       [](Impl& p, const Action& a) {
         const Vec3d at = place_at(p, a, 0), normal = vector_at(a, 3);
         if (!(length(normal) > 0)) throw InputError("cut: the normal must not be 0");
         const Turn turn = turn_to(normalized(normal));
         const SceneShape disc =
             SceneShape::yaml(fmt::format("{{cylinder: {{radius: {}, height: {}}}, center: [{}, {}, {}], rotate: "
                                          "{{axis: [{}, {}, {}], angle: {}}}}}",
                                          size_at(p, a, 6), 2 * p.play_scene().scene.spacing(), at.x, at.y, at.z,
                                          turn.axis.x, turn.axis.y, turn.axis.z, turn.angle));
         p.before_edit("cut");
         const std::size_t before = p.simulation->particle_count();
         p.say(taken_text(p.simulation->remove(disc), before));
       }},
      {"pin", "X Y Z RADIUS | off", "holds matter where it is; off: lets all of it go",
       [](Impl& p, const Action& a) {
         if (is_off(a)) return p.let_pins_go();
         p.pin({place_at(p, a, 0), size_at(p, a, 3), {}, pin_rate});
       }},
      {"wall", "SIDE POSITION | off",
       "drags a wall, as x_min, to that place along its axis [m], as fast as matter gives way; off: all go back", wall},
      Verb{"save", "FILE.yaml", "writes a scene that `dreampm make` runs, with the particles beside it",
           [](Impl& p, const Action& a) { p.save(a.word(0)); }}
          .on_one_side(always),
      Verb{"estimate", "FILE.yaml [SECONDS [FROM TO FOV]]",
           "saves a scene of 8 times the particles, and says what its film will take",
           [](Impl& p, const Action& a) { p.render(a, false); }}
          .unrecorded()
          .on_one_side(always),
      Verb{"render", "FILE.yaml [SECONDS [FROM TO FOV]] | off | leave",
           "saves a scene of 8 times the particles, and makes its film in the background; off: stops it, dreampm make "
           "goes "
           "on with it, and of an estimate nothing stays; leave: it outlives this program",
           [](Impl& p, const Action& a) {
             const bool off = is_off(a), leave = a.words.size() == 1 && a.words[0] == "leave";
             if (!off && !leave) return p.render(a, true);
             std::optional<Rendering>& rendering = p.films->rendering;
             if (!rendering) throw InputError("render: there is no film under way");
             if (off)
               rendering->stop();
             else
               rendering->leave();
           }}
          .unrecorded()
          .on_one_side(always),
      Verb{"film", "FILE.mp4 [30 | 60] | off", "films the picture, at 60 frames a second unless said otherwise",
           [](Impl& p, const Action& a) {
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
           }}
          .unrecorded()
          .on_one_side(always),
      {"shake", "X Y Z", "a push of the whole box [m/s^2], which fades",
       [](Impl& p, const Action& a) { p.shake = vector_at(a, 0); }},
  };
  return all;
}

}  // namespace dreampm::play
