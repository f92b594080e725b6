// A run as other programs get it: what its frames have in common, one frame, and what writes them.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/export/axes.h"
#include "dreampm/export/material.h"
#include "dreampm/pose.h"

namespace dreampm::exchange {

/// A collider or a rigid body.
struct ClipObject {
  ClipMaterial look;     ///< its name is the object's
  TriMesh mesh;          ///< as the scene gives it; places count from ClipInfo::shift. Empty if it deforms
  bool deforms = false;  ///< each frame has a mesh of it then
};

/// An object in one frame.
struct ObjectState {
  Pose pose{};     ///< of the object's mesh, in the axes and the unit of the file
  TriMesh mesh{};  ///< of one that deforms
};

/// A camera in the axes and the unit of the file.
struct ClipCamera {
  Vec3d eye;
  Vec3d right, up, forward;  ///< unit length
  double fov = 34;           ///< degrees, vertical
  double aspect = 16.0 / 9;  ///< width over height
  double far = 100;          ///< beyond everything that it sees
};

/// What all frames have in common.
struct ClipInfo {
  std::string name;
  Axes axes;
  double fps = 24;
  int first = 1, last = 1;              ///< frame n is at (n - 1)/fps
  double spacing = 0.01;                ///< between particles, in the unit of the file
  Vec3d shift{};                        ///< where places of particles and meshes count from
  std::vector<ClipMaterial> materials;  ///< ParticleFrame::material counts them
  bool particles = true;                ///< whether frames have them
  bool foam = false;                    ///< whether frames have spray, foam, bubbles and dust
  ClipMaterial foam_look{"foam"};       ///< of all of it
  std::vector<int> meshed;              ///< the materials of ClipFrame::meshes
  std::vector<ClipObject> objects;      ///< the scene's colliders and rigid bodies, in its order
  std::optional<ClipCamera> camera;

  double time(int frame) const { return (frame - 1) / fps; }
  /// "a unit of 0.01 m, Z up"
  std::string units() const;
  /// "surface", or "water-surface" where several materials are meshed.
  std::string mesh_name(std::size_t mesh) const;
  /// Of a file with an object alone: "collider-crate".
  std::string object_name(std::size_t object) const { return "collider-" + objects[object].look.name; }
};

/// One frame, in the axes and the unit of the file.
struct ClipFrame {
  int number = 1;
  ParticleFrame particles;
  std::vector<Vec3f> colors;    ///< linear, of each particle; empty: they have those of their materials
  std::vector<TriMesh> meshes;  ///< one for each of ClipInfo::meshed
  /// What the vertices of the meshes hold, one for each; empty: nothing.
  std::vector<VertexAttributes> attributes{};
  /// With columns type, age and life [s], and radius in the unit of the file; all of one material.
  ParticleFrame foam{};
  std::vector<ObjectState> objects;  ///< one for each of ClipInfo::objects

  const VertexAttributes& attributes_of(std::size_t mesh) const {
    static const VertexAttributes none;
    return mesh < attributes.size() ? attributes[mesh] : none;
  }
};

/// An object where it stands in a frame.
TriMesh placed(const ClipObject& object, const ObjectState& state);

/// Takes frames in rising order. What it writes is whole or absent: a file of all frames appears by
/// `finish`, files of single frames as they come.
class ClipWriter {
 public:
  virtual ~ClipWriter() = default;
  virtual void add(const ClipFrame& frame) = 0;
  virtual void finish() {}
};

/// A kind of file.
struct Format {
  const char* name;       ///< as --to has it
  const char* about;      ///< for --help
  const char* extension;  ///< ".ply"
  bool y_up;              ///< Y is up by the definition of the format
  /// The files of `target` that all frames of a clip become; null where each frame has files of its
  /// own in a folder.
  std::vector<std::filesystem::path> (*files)(const ClipInfo& clip, const std::filesystem::path& target);
  std::unique_ptr<ClipWriter> (*writer)(const ClipInfo& clip, const std::filesystem::path& target);
  bool one_file() const { return files != nullptr; }
};
/// The list of export/formats.h.
const std::vector<Format>& formats();

}  // namespace dreampm::exchange
