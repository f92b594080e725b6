// What tools have in common: the words of their verbs, and what lies where they work.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "dreampm/play/model/action.h"
#include "dreampm/play/model/play_model.h"
#include "dreampm/play/model/verb.h"
#include "dreampm/vec.h"

namespace dreampm::play {

/// The three numbers from that place of the words on.
Vec3d vector_at(const Action& action, std::size_t at);
/// Throws InputError for a number that is not above 0.
double positive_at(const Action& action, std::size_t at);
/// A length of what is in a place. One beyond the box would be cells without end: it throws
/// InputError.
double size_at(const PlayModel& side, const Action& action, std::size_t at);
/// A place in the box, or near it. Throws InputError for others.
Vec3d place_at(const PlayModel& side, const Action& action, std::size_t at);
/// m, from corner to corner.
double box_size(const PlayModel& side);
/// Whether "off" is the only word.
bool is_off(const Action& action);

/// As shapes are turned in scenes: degrees about an axis.
struct Rotation {
  Vec3d axis;
  double angle;
};
/// From the y axis to `direction`, a unit vector.
Rotation rotation_to(const Vec3d& direction);

/// The rigid body whose surface is there; empty: none.
std::string body_at(const PlayModel& side, const Vec3d& at);

/// A verb that is a function `act` of the tool `T` of the side.
template <class T, void (T::*act)(PlayModel&, const Action&)>
Verb tool_verb(std::string_view name, std::string_view usage, std::string_view help) {
  return {name, usage, help, [](PlayModel& side, const Action& action) { (side.tools.get<T>().*act)(side, action); }};
}

}  // namespace dreampm::play
