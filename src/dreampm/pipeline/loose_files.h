// Surfaces and pictures of anybody's particles and meshes: files without a run.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/export/axes.h"
#include "dreampm/pipeline/render_stage.h"

namespace dreampm {

struct LooseSurfaces {
  std::vector<std::string> files;  ///< clouds of points (import/point_file.h), a file a frame
  std::optional<double> spacing;   ///< between particles, in the unit of the files
  std::filesystem::path out = "surface";
  double voxel = 0.5;  ///< in spacings
  int smooth = 2;
};
/// Wraps each cloud in a mesh OUT/NAME.ply, with velocities where it has them. Places are in the
/// unit and the axes of the files, and count from where their headers say (io/ply.h: ply_shift).
/// Throws InputError for a file that cannot be read, is a mesh, or would be written over, for two
/// of one name, and without a spacing, naming the one that the first file has; Interrupted between
/// files.
std::vector<std::filesystem::path> surface_files(const LooseSurfaces& request);

struct LoosePictures {
  std::vector<std::string> files;  ///< clouds of points or meshes, a file a frame
  std::optional<double> spacing;   ///< of clouds: their balls have half of it as radius; absent: as they lie
  std::filesystem::path out = "render";
  exchange::Up up = exchange::Up::y;
  std::string look;                     ///< one of picture_looks(); empty: water for closed meshes, else clay
  PictureWishes wishes;                 ///< of 1280 x 720 pixels
  std::optional<PixelBox> crop;         ///< draw only that part
  double azimuth = 60, elevation = 14;  ///< degrees: where the camera stands
};
/// The names of looks.
std::vector<std::string> picture_looks();
/// Draws each file as OUT/NAME.png, on a floor at the lowest place of all, from one camera that
/// sees all of them. A closed mesh or balls, in the colors of the file where it has them. Throws as
/// surface_files does.
std::vector<std::filesystem::path> render_files(const LoosePictures& request);

}  // namespace dreampm
