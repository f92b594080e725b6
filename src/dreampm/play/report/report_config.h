// The settings of the report that asked for this project (its config.yaml), and its presets as
// scenes. Keys have blanks in them: "grid number", "max timestep", "max hard", "default color".
#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm::play {

/// The ids that the report's program knows: what an object does follows from its id, not its name.
inline constexpr int diy_material = 0, solid_cube = 1;

struct ReportMaterial {
  int id = diy_material;
  std::string name;
  std::array<double, 4> color{1, 1, 1, 1};  ///< red, green, blue and opacity, 0 to 1
  friend bool operator==(const ReportMaterial&, const ReportMaterial&) = default;
};

/// Objects that start at rest; the i-th of each list belongs to the i-th object.
struct ReportPreset {
  std::string name;
  std::vector<int> material;         ///< ids of ReportConfig::materials
  std::vector<Vec3d> minimum, size;  ///< m, of boxes inside of the unit cube
  friend bool operator==(const ReportPreset&, const ReportPreset&) = default;
};

struct ReportConfig {
  int width = 1920, height = 1080;  ///< px, of the window
  int grid = 32;                    ///< cells along an edge of the unit cube, 8 to 256
  double max_time_step = 4;         ///< 1e-4 s: the end of the slider
  double max_hard = 4;              ///< the end of the slider; the solid cube is as hard as that
  std::vector<ReportMaterial> materials;
  std::vector<ReportPreset> presets;
  friend bool operator==(const ReportConfig&, const ReportConfig&) = default;
};

/// Reads a config.yaml of the report's program. Throws InputError with every error on a line of its
/// own: FILE:LINE:COLUMN: what is wrong, and what would be right.
ReportConfig load_report_config(const std::filesystem::path& file);
/// The same for text; `name` stands for the file in messages.
ReportConfig parse_report_config(std::string_view text, const std::string& name);

/// The report's own: a grid of 32, two presets.
ReportConfig report_config();

/// The text of a scene with the objects of a preset in the unit cube: materials `diy` (type seed,
/// at the report's defaults) and `cube` (elastic), about grid^3/4 particles shared out by volume,
/// and cells of 1/grid where 1 to 64 particles a cell allow it. `preset` counts from 0.
/// Throws InputError for one that the config has not.
std::string report_scene(const ReportConfig& config, std::size_t preset);
/// What the scene calls a material of the config.
std::string report_material_name(int id);

}  // namespace dreampm::play
