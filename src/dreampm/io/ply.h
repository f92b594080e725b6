// PLY files that dreampm writes and reads back: particle frames and surface meshes. Foreign meshes are geometry/'s.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/math/vec.h"

namespace dreampm {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one value.
std::size_t ply_size(PlyType type);
/// The name as a header writes it: "char", "uchar", "short", "ushort", "int", "uint", "float", "double".
const char* ply_name(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  ///< of the value, or of each item of a list
  bool list = false;
  PlyType count_type = PlyType::uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The property of this name, or null.
  const PlyProperty* find(std::string_view property) const;
  bool has_list() const;
  /// Bytes of one row in a binary file; a list counts as its length field alone.
  std::size_t row_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< without the word "comment"
  std::uint64_t data_offset = 0;      ///< of the first byte after the header
  std::uint64_t file_bytes = 0;

  /// The element of this name, or null.
  const PlyElement* find(std::string_view element) const;
};

/// Reads and checks a header: magic, format 1.0, known types, no duplicate names, and counts that the size of the file
/// allows, so that nothing is allocated for an absurd count. Throws InputError naming the file, the line and what is
/// wrong.
PlyHeader read_ply_header(const std::filesystem::path& file);

/// The comment "shift X Y Z" [m] of a header, zero without one: add it to x y z to have the places in the scene. Files
/// of scenes far from the origin have it, because a float would lose digits there. Throws InputError if it is broken.
Vec3d ply_shift(const PlyHeader& header, const std::string& file);

/// One frame of particles, a column each; all columns have size() rows, optional ones may be empty.
struct ParticleFrame {
  std::vector<Vec3f> position;         ///< m, from `shift`
  std::vector<Vec3f> velocity;         ///< m/s
  std::vector<std::int32_t> id;        ///< stays with a particle through a run
  std::vector<std::uint8_t> material;  ///< index into material_names
  std::vector<std::string> material_names;
  /// Optional: f_00..f_22 (deformation gradient, row and column), j, jp, density (kg/m^3), pressure (Pa), or others.
  std::map<std::string, std::vector<float>> columns;
  std::vector<std::array<std::uint8_t, 4>> color;  ///< red green blue alpha, or empty
  Vec3d shift{};                                   ///< m, where positions count from; see ply_shift

  std::size_t size() const { return position.size(); }
};

/// Writes binary little-endian PLY as FORMATS says, through replace_file. Throws InputError if columns differ in length
/// or a material has no name, RunError if the file cannot be written.
void write_particles(const std::filesystem::path& file, const ParticleFrame& frame);

/// Reads what write_particles wrote (also ascii, and any order or numeric type of the properties). x y z must be there;
/// without vx vy vz, id or material: zeros, 0.. and 0. Throws InputError.
ParticleFrame read_particles(const std::filesystem::path& file);

/// Writes float x y z, nx ny nz and vx vy vz where present, and faces (uchar count, int indices). Throws InputError if
/// sizes differ or an index is out of range, RunError if the file cannot be written. `shift`: where vertices count
/// from; the file says so as particle files do.
void write_mesh(const std::filesystem::path& file, const TriMesh& mesh, const Vec3d& shift = {});

/// Reads a PLY surface mesh (binary little-endian or ascii); faces of 4 become two triangles. Vertices are as in the
/// file, without its shift. Throws InputError.
TriMesh read_mesh(const std::filesystem::path& file);

/// Writes a Wavefront OBJ with normals where present; coordinates read back exactly. Velocities are not part of OBJ.
/// `shift`: where vertices count from; it is added, since OBJ holds decimal numbers.
void write_obj(const std::filesystem::path& file, const TriMesh& mesh, const Vec3d& shift = {});

}  // namespace dreampm
