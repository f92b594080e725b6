// A scene: what a run starts from, checked and complete.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm {

namespace scene {
struct SceneDescription;
}

/// How a scene file is read.
struct SceneOptions {
  std::string variant;           ///< one of the file's variants; empty: the scene as it stands
  std::vector<std::string> set;  ///< PATH=VALUE each, laid over the variant: "space.spacing=0.01"
};

/// A checked scene with every default filled in. Immutable, cheap to copy, safe to share between
/// threads.
class Scene {
 public:
  Scene(scene::SceneDescription description, std::string file);

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

  /// All that it says, in the library's own types (dreampm/scene/description.h, which is not
  /// installed).
  const scene::SceneDescription& description() const;

 private:
  struct Data;
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

/// A line for each part of a scene that its `time.solver` cannot do, with its place and what would
/// be right. A Simulation of a scene that has any is refused with them.
std::vector<std::string> refused_parts(const Scene& scene);

}  // namespace dreampm
