// A scene: what a run starts from, checked and complete. It comes from a file, from text, or from
// the structs of model/scene.h.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/vec.h"

namespace dreampm {

/// Options for reading a scene file.
struct SceneOptions {
  std::string variant;           ///< one of the file's variants; empty: the scene as it stands
  std::vector<std::string> set;  ///< PATH=VALUE each, laid over the variant: "space.spacing=0.01"
};

/// A checked scene with every default filled in. Immutable, cheap to copy, safe to share between
/// threads.
class Scene {
 public:
  /// Checks a scene that a program built, and fills in what follows from the rest: parameters that
  /// its materials leave out, looks, the folder. Reads no file: models are looked for where a
  /// Simulation fills the scene. Throws InputError with every problem on a line of its own. `file`
  /// names the scene in messages, its name does if it is empty.
  explicit Scene(dreampm::model::Scene model, std::string file = {});

  const std::string& name() const;
  /// The file, as messages name it.
  const std::string& file() const;
  /// m: corners of the box of walls.
  Vec3d min() const;
  Vec3d max() const;
  double spacing() const;  ///< m, between particles
  double fps() const;      ///< frames a second of simulated time
  int frames() const;      ///< frame 1 is the start, frame n is at (n - 1)/fps
  std::vector<std::string> materials() const;
  /// The whole scene as a scene file, every value explicit.
  std::string yaml() const;
  /// The same scene with values laid over it, PATH=VALUE each. Throws InputError.
  Scene with(const std::vector<std::string>& set) const;

  /// All that it says.
  const dreampm::model::Scene& model() const;

 private:
  struct Data;
  friend struct SceneAccess;  // the library's own files
  explicit Scene(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

/// Reads and checks a scene file. Throws InputError with every error on a line of its own, as
/// `dreampm check` prints them: FILE:LINE:COLUMN: what is wrong, and what would be right.
/// `warnings`: filled, if not null.
Scene load_scene(const std::filesystem::path& file, const SceneOptions& options = {},
                 std::vector<std::string>* warnings = nullptr);

/// The same for text; `name` stands for the file in messages, and models are looked for in its
/// folder.
Scene parse_scene(std::string_view yaml, const std::string& name, const SceneOptions& options = {},
                  std::vector<std::string>* warnings = nullptr);

/// Returns the faults of a scene that a program built, a line each, by path:
/// "bodies.drop.shape.sphere.radius is -1: must be above 0 m". Empty if there are none. Reads no
/// file.
std::vector<std::string> check(const model::Scene& model);

/// Returns the meaning of a key of scene files in a sentence: about_key("space.spacing"). Names
/// that scenes give are left out: "bodies.velocity". Empty for an unknown key.
std::string about_key(std::string_view path);

/// The values of a preset, as `dreampm materials TYPE` lists them: preset("newtonian", "honey").
/// Throws InputError for a type or preset that there is not.
Values preset(std::string_view type, std::string_view name);

/// A shape, material or look as it stands behind that key in a scene file: "{sphere: {radius: 0.1},
/// center: [0, 1, 0]}". Throws InputError for what a scene file would not take; `name` stands for
/// the file in messages, and models are looked for in its folder.
Shape parse_shape(std::string_view yaml, const std::string& name = "shape");
/// The other way.
std::string shape_yaml(const Shape& shape);
/// The material is called by the name.
model::Material parse_material(std::string_view yaml, const std::string& name = "material");
model::Look parse_look(std::string_view yaml, const std::string& name = "look");

/// A line for each part of a scene that its `time.solver` cannot do, with its place and what would
/// be right. A Simulation of a scene that has any is refused with them.
std::vector<std::string> refused_parts(const Scene& scene);
/// The same of a model that is right but for that.
std::vector<std::string> refused_parts(const model::Scene& model);

}  // namespace dreampm
