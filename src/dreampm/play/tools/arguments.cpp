#include "dreampm/play/tools/arguments.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/queries.h"

namespace dreampm::play {

Vec3d vector_at(const Action& a, std::size_t at) { return {a.number(at), a.number(at + 1), a.number(at + 2)}; }

double positive_at(const Action& a, std::size_t at) {
  const double value = a.number(at);
  if (!(value > 0)) throw InputError(a.verb + ": " + a.word(at) + " must be above 0");
  return value;
}

double box_size(const PlayModel& side) {
  const model::Space& space = side.simulation->scene().model().space;
  return length(space.end() - space.min);
}

double size_at(const PlayModel& side, const Action& a, std::size_t at) {
  const double value = positive_at(a, at), most = box_size(side);
  if (value > most)
    throw InputError(fmt::format("{}: {} m is more than the box has, {:.4g} m", a.verb, a.word(at), most));
  return value;
}

Vec3d place_at(const PlayModel& side, const Action& a, std::size_t at) {
  constexpr double near = 100;
  const model::Space& space = side.simulation->scene().model().space;
  const Vec3d place = vector_at(a, at);
  if (!(length(place - (space.min + space.end()) * 0.5) <= near * box_size(side)))
    throw InputError(fmt::format("{}: ({}, {}, {}) is far from the box", a.verb, place.x, place.y, place.z));
  return place;
}

bool is_off(const Action& a) { return a.words.size() == 1 && a.words[0] == "off"; }

Rotation rotation_to(const Vec3d& direction) {
  const Vec3d axis = cross(Vec3d{0, 1, 0}, direction);
  const double sine = length(axis);
  return {sine > 1e-9 ? axis * (1 / sine) : Vec3d{1, 0, 0}, std::atan2(sine, direction.y) * 180 / std::numbers::pi};
}

std::string body_at(const PlayModel& side, const Vec3d& at) {
  constexpr double touching = 0.5;  // spacings
  std::string name;
  double nearest = touching * side.play_scene().scene.spacing();
  for (const NearCollider& body : colliders_near(*side.simulation, at, nearest))
    if (body.is_rigid && body.distance < nearest) nearest = body.distance, name = body.name;
  return name;
}

}  // namespace dreampm::play
