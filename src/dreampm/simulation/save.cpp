// Writes a simulation as a scene that goes on from its moment, and goes on from one.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/import/asset.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/files.h"
#include "dreampm/scene/sections.h"
#include "dreampm/setup/start.h"
#include "dreampm/simulation/finer.h"
#include "dreampm/simulation/simulation_impl.h"

namespace dreampm {

void Simulation::Impl::save(const std::filesystem::path& file) const {
  if (file.extension() != ".yaml") fail_input("save: {} must end in .yaml", file.string());
  model::Scene now = state.scene.model();
  now.name = file.stem().string();
  if (!scene::good_name(now.name))
    fail_input("save: {}: the scene's name, '{}', must be {}", file.string(), now.name, scene::good_name_rule);
  now.output.folder = "out/" + now.name;
  now.bodies.clear();
  now.start.clear();
  now.time.frames = std::max(now.time.frames, with_engine([](auto& engine) { return engine.world().frame; }));
  scene::each_model(now, [](std::string& path) {
    if (!is_asset(path)) path = std::filesystem::absolute(path).string();
  });
  if (!file.parent_path().empty()) make_folder(file.parent_path());
  check_replaceable(file);
  std::filesystem::path moment = file;
  moment.replace_extension(".start.h5");
  with_engine([&](auto& engine) {
    const auto& world = engine.world();
    for (std::size_t f = now.fields.size(); f < world.fields.size(); ++f) {
      const std::string& name = world.fields[f].name;
      if (!scene::good_name(name))
        fail_input("save: the brush '{}' becomes a field of the scene, whose name must be {}", name,
                   scene::good_name_rule);
      model::ForceField& field = now.fields.emplace_back(as_model(world.fields[f].field));
      field.name = name, field.box = world.fields[f].box;
    }
    // The motion that a program set is in the moment; a scene has no word for it.
    for (std::size_t c = 0; c < world.colliders.size(); ++c)
      if (!world.colliders[c].path) now.colliders.at(c).motion.reset();
  });
  save_moment(moment);
  // Beside the scene, where it is looked for first.
  now.start = moment.filename().string();
  replace_file_text(file, scene::write_scene(now));
}

void Simulation::Impl::save_moment(const std::filesystem::path& file) const {
  settle();
  with_engine([&](auto& engine) {
    engine.download(MatterFields::all);
    write_start(file, engine.world(), engine.motion(), state.expected);
  });
}

void Simulation::save(const std::filesystem::path& file) const { impl_->save(file); }
void Simulation::save_moment(const std::filesystem::path& file) const { impl_->save_moment(file); }

void Simulation::save_moment(const std::filesystem::path& file, const Scene& finer) const {
  const model::Scene &own = scene().model(), &other = finer.model();
  const bool fits = other.space.spacing == own.space.spacing / 2 && other.space.min == own.space.min &&
                    other.space.end() == own.space.end() && finer.materials() == scene().materials() &&
                    other.colliders.size() == own.colliders.size() && other.emitters.size() == own.emitters.size();
  if (!fits)
    fail_input("save_moment: {} must be {} with space.spacing {:.6g} m, half of what it is, and all else as it is",
               finer.name(), own.name, own.space.spacing / 2);
  impl_->settle();
  impl_->with_engine([&](auto& engine) {
    engine.download(MatterFields::all);
    write_finer(file, engine.world(), engine.motion(), other, finer.file(), impl_->state.expected);
  });
}

void Simulation::load(const std::filesystem::path& file) {
  if (impl_->under_way > 0)
    fail_input("load: {} cannot be loaded while steps are under way: not inside of an observer", file.string());
  auto next = std::make_unique<Impl>(load_scene(file), impl_->options);
  next->take_attached(*impl_);
  next->step_observers = std::move(impl_->step_observers);
  next->frame_observers = std::move(impl_->frame_observers);
  impl_ = std::move(next);
}

}  // namespace dreampm
