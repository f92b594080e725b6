// PLY files that dreampm writes and reads back: particle frames and surface meshes. Foreign meshes
// and clouds are read by geometry/; headers and values by one reader for all
// (import/ply_header.h, import/ply_values.h).
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/geometry/vertex_attributes.h"
#include "dreampm/import/ply_header.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// The comment "shift X Y Z" [m] of a header, zero without one: add it to x y z to have the places
/// in the scene. Files of scenes far from the origin have it, because a float would lose digits
/// there. Throws InputError if it is broken.
Vec3d ply_shift(const PlyHeader& header, const std::string& file);
/// The same of a file of any kind: zero of others than PLY.
Vec3d read_ply_shift(const std::filesystem::path& file);
/// The header's line for it; empty for none.
std::string ply_shift_comment(const Vec3d& shift);

/// A note in the headers of a run's files.
inline constexpr const char* si_note = "SI units, Y up";

/// One frame of particles, a column each; all columns have size() rows, optional ones may be empty.
struct ParticleFrame {
  std::vector<Vec3f> position;         ///< m, from `shift`
  std::vector<Vec3d> exact;            ///< the same in double, written instead of position; or empty
  std::vector<Vec3f> velocity;         ///< m/s
  std::vector<std::int32_t> id;        ///< stays with a particle through a run
  std::vector<std::uint8_t> material;  ///< index into material_names
  std::vector<std::string> material_names;
  /// The emitters and bodies that the column `source` counts from 0; -1 there: unknown. May be
  /// empty.
  std::vector<std::string> source_names;
  /// Optional: f_00..f_22 (deformation gradient, row and column), j, jp, density (kg/m^3), pressure
  /// (Pa), or others.
  std::map<std::string, std::vector<float>> columns;
  std::vector<std::array<std::uint8_t, 4>> color;  ///< red green blue alpha, or empty
  Vec3d shift{};                                   ///< m, where positions count from; see ply_shift

  std::size_t size() const { return position.size(); }
};

/// Writes binary little-endian PLY as FORMATS says, through replace_file. Throws InputError if
/// columns differ in length or a material has no name, RunError if the file cannot be written.
/// `note` is a comment in the header, a line about units and axes; so it is for meshes.
void write_particles(const std::filesystem::path& file, const ParticleFrame& frame, const std::string& note = si_note);

/// Reads what write_particles wrote (also ascii, big-endian or packed with gzip, and any order or
/// numeric type of the properties). x y z must be there; without vx vy vz, id or material: zeros,
/// 0.. and 0. Throws InputError.
ParticleFrame read_particles(const std::filesystem::path& file);

/// Writes float x y z, nx ny nz and vx vy vz where present, and faces (uchar count, int indices).
/// Attributes follow: numbers as float NAME, whole ones as int NAME, vectors as float NAME_x,
/// NAME_y, NAME_z, and the color as uchar red, green, blue in sRGB. Throws InputError if sizes
/// differ or an index is out of range, RunError if the file cannot be written. `shift`: where
/// vertices count from; the file says so as particle files do.
void write_mesh(const std::filesystem::path& file, const TriMesh& mesh, const Vec3d& shift = {},
                const std::string& note = si_note, const VertexAttributes& attributes = {});

/// Reads a PLY surface mesh (as read_particles does); faces of 4 become two triangles. Vertices are
/// as in the file, without its shift. All other values of vertices go to `attributes`, if that is
/// not null. Throws InputError.
TriMesh read_mesh(const std::filesystem::path& file, VertexAttributes* attributes = nullptr);

/// Writes a Wavefront OBJ with normals where present; coordinates read back exactly. Of the
/// attributes it holds the color alone, in sRGB behind the coordinates, as many programs read it.
/// Velocities are not part of OBJ. `shift`: where vertices count from; it is added, since OBJ holds
/// decimal numbers.
void write_obj(const std::filesystem::path& file, const TriMesh& mesh, const Vec3d& shift = {},
               const std::string& note = si_note, const VertexAttributes& attributes = {});
/// Returns the OBJ line of a vertex.
std::string obj_vertex(const Vec3f& v, const Vec3d& shift);

}  // namespace dreampm
