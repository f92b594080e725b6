// A scene file becomes a checked description.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/import/asset_names.h"
#include "dreampm/model/scene.h"
#include "dreampm/scene/problem.h"

namespace dreampm::scene {

inline constexpr int format_version = 1;  ///< of scene files: `dreampm: 1`

struct ParseOptions {
  std::string variant;                    ///< empty: the scene as it stands
  std::vector<std::string> overrides;     ///< PATH=VALUE each, as in space.spacing=0.01; laid over the variant
  std::string overrides_from = "--set ";  ///< what stands before them in messages
  std::vector<std::string> assets = asset_names();  ///< what asset:NAME may name
  /// The scene of a run's folder: models lie there and nowhere else, and may be gone, since not
  /// every stage needs them.
  bool of_run = false;
};

struct ParseResult {
  model::Scene scene;                 ///< complete only if ok()
  std::vector<Problem> problems;      ///< all of them, by line; warnings too
  std::vector<std::string> variants;  ///< names of the file's variants
  bool ok() const;
  /// Every problem on a line of its own.
  std::string text() const;
};

/// Parses and checks a scene given as text. `file` names it in messages, and its folder is where
/// meshes are looked for first. Without overrides the scene as it stands and every variant are
/// checked too, whichever was asked for. Throws nothing for what a user did wrong.
ParseResult parse_scene_text(std::string_view text, const std::string& file, const ParseOptions& options = {});

/// The same for a file; one that cannot be read is a problem without a line.
ParseResult parse_scene(const std::filesystem::path& path, const ParseOptions& options = {});

/// The scene, or InputError with every error on a line of its own. Warnings are handed to
/// `warnings` if it is given.
model::Scene load_scene(const std::filesystem::path& path, const ParseOptions& options = {},
                        std::vector<Problem>* warnings = nullptr);

}  // namespace dreampm::scene
