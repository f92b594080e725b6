// Surfaces and pictures of anybody's particles and meshes: files without a run.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/export/axes.h"
#include "dreampm/model/foam.h"
#include "dreampm/model/render.h"
#include "dreampm/pipeline/render_stage.h"

namespace dreampm {

struct LooseSurfaces {
  std::vector<std::string> files;  ///< clouds of points (import/point_file.h), a file a frame
  std::optional<double> spacing;   ///< between particles, in the unit of the files
  std::filesystem::path out = "surface";
  double voxel = 0.5;  ///< in spacings
  int smooth = 2;
  model::SurfaceType type = model::SurfaceType::mesh;
  std::vector<std::string> attributes;  ///< of cloud_attributes; empty: velocity, where a cloud has it
};
/// What the vertices of meshes of clouds can hold: velocity, vorticity, color.
std::vector<std::string> cloud_attributes();
/// Wraps each cloud in a mesh OUT/NAME.ply, or writes a volume OUT/NAME.vdb (surface/vdb.h) of one
/// that is not `mesh`. Places are in the
/// unit and the axes of the files, and count from where their headers say (io/ply.h: ply_shift).
/// Throws InputError for a file that cannot be read, is a mesh, or would be written over, for two
/// of one name, without a spacing, naming the one that the first file has, for an attribute that a
/// cloud has not, and for attributes of a volume; Interrupted between files.
std::vector<std::filesystem::path> surface_files(const LooseSurfaces& request);

struct LooseFoam {
  std::vector<std::string> files;  ///< clouds of points with velocities, each a frame, in their order
  std::optional<double> spacing;   ///< m, between particles
  double fps = 24;                 ///< frames a second
  std::filesystem::path out = "foam";
  exchange::Up up = exchange::Up::y;  ///< gravity pulls the other way
  model::Foam foam;                   ///< `of` and `color` do not matter
};
/// Makes the foam of a liquid, OUT/NAME.ply for each file, as `foam_stage` makes that of a run,
/// without walls. Files are in meters and seconds. Limits that `foam` does not give are found of
/// all files first. Throws InputError as surface_files does, for files without velocities, and
/// where particles cannot be followed from file to file: by ids, or by their places in files of
/// equally many; Interrupted between files.
std::vector<std::filesystem::path> foam_of_files(const LooseFoam& request);

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
