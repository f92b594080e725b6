// Places where matter is held: brushes of the simulation that stand still.
#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "dreampm/error.h"
#include "dreampm/play/model/playground_impl.h"
#include "dreampm/scene/description.h"

namespace dreampm::play {
namespace {

constexpr std::string_view prefix = "pin-";

const Brush* pin_of(const dreampm::ForceField& field) {
  return field.name.starts_with(prefix) ? std::get_if<Brush>(&field.field) : nullptr;
}

}  // namespace

Pins pins_of(const Simulation& simulation) {
  Pins all;
  for (const std::string& name : simulation.names().brushes)
    if (name.starts_with(prefix)) all.emplace_back(name, *simulation.brush(name));
  return all;
}

Pins take_pins(Scene& scene) {
  Pins all;
  for (const scene::ForceField& field : scene.description().fields)
    if (const Brush* brush = pin_of(field))
      all.emplace_back(field.name, Stroke{brush->point, brush->radius, brush->velocity, brush->rate});
  if (all.empty()) return all;
  scene::SceneDescription bare = scene.description();
  std::erase_if(bare.fields, [](const ForceField& field) { return pin_of(field) != nullptr; });
  scene = Scene(std::move(bare), scene.file());
  return all;
}

void Playground::Impl::pin(const Stroke& hold) {
  const Pins all = pins_of(*simulation);
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(all.begin(), all.end(), [&](const auto& pin) { return pin.first == name; });
  };
  int number = 1;
  while (is_taken(fmt::format("{}{}", prefix, number))) ++number;
  history.separate();
  before_edit("pin");
  history.separate();
  simulation->set_brush(fmt::format("{}{}", prefix, number), hold);
}

void Playground::Impl::let_pins_go() {
  const Pins all = pins_of(*simulation);
  if (all.empty()) throw InputError("pin: nothing is held");
  history.separate();
  before_edit("pin off");
  history.separate();
  for (const auto& [name, stroke] : all) simulation->lift_brush(name);
}

std::vector<PinFrame> Playground::Impl::pins() const {
  std::vector<PinFrame> all;
  for (const auto& [name, stroke] : pins_of(*simulation))
    all.push_back({static_cast<Vec3f>(stroke.point), static_cast<float>(stroke.radius)});
  return all;
}

}  // namespace dreampm::play
