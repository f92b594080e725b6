// The content of a file of geometry, as plain arrays: a mesh, or a cloud of points.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// Coordinates are those of the file, in double: a model 500 km from the origin keeps its
/// millimeters.
struct Model {
  std::vector<Vec3d> vertices;
  std::vector<Vec3d> velocities;                        ///< m/s, one a vertex, where the file has them; or empty
  std::vector<std::int64_t> ids;                        ///< one a vertex, where the file has them; or empty
  std::vector<std::array<std::uint8_t, 4>> colors;      ///< red green blue alpha, one a vertex; or empty
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< empty: a cloud of points
  std::vector<std::string> warnings;                    ///< what was mended or passed over; each names the file
  std::size_t parts = 0;  ///< groups of faces that hang together by edges of two faces; 0: not counted
};

Model model_of(const TriMesh& mesh);

/// Returns the bounds of the vertices that faces name; of all vertices where there are no faces.
Box3d bounds_of(const Model& model);

/// Returns the volume that a closed mesh encloses, where it does so once; below 0 if its faces look
/// inward. Otherwise the signed sum over all faces.
double enclosed_volume(const Model& model);
double surface_area(const Model& model);

/// The same mesh in float, `origin` taken from its vertices before digits are lost.
TriMesh about(const Model& model, const Vec3d& origin);

/// Throws InputError, naming file and vertex, where a coordinate is not finite or beyond what float
/// holds.
void require_finite(const Model& model, const std::string& name);

/// Returns for every vertex the first one at its place; all are finite.
std::vector<std::uint32_t> by_place(const std::vector<Vec3d>& vertices);

/// One vertex a place, which all faces there name. Of vertices without columns.
void join_corners(Model& model);

/// Appends the polygon as triangles that have its direction. Corners name vertices of the model;
/// fewer than 3 add nothing. A polygon with inward corners is cut at its ears, seen along its mean
/// normal.
void add_polygon(Model& model, const std::vector<std::uint32_t>& corners);

/// Appends a strip of triangles, of which every other one is turned.
void add_strip(Model& model, const std::vector<std::uint32_t>& strip);

/// A part of a color, cut to 0 to 255.
std::uint8_t color_byte(double value);

}  // namespace dreampm
