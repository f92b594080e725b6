// The axes and the unit of other programs.
#pragma once
#include "dreampm/geometry/mesh.h"
#include "dreampm/geometry/vertex_attributes.h"
#include "dreampm/io/ply.h"
#include "dreampm/math/vec.h"

namespace dreampm::exchange {

enum class Up { y, z };

/// Turns what is in meters with Y up into the axes and the unit of a file.
struct Axes {
  Up up = Up::y;
  double scale = 1;  ///< units of the file a meter

  /// A direction: with Z up, (x, y, z) becomes (x, -z, y), a quarter turn about x.
  template <class R>
  Vec3<R> turned(const Vec3<R>& v) const {
    return up == Up::z ? Vec3<R>{v.x, -v.z, v.y} : v;
  }
  template <class R>
  Vec3<R> turned_back(const Vec3<R>& v) const {
    return up == Up::z ? Vec3<R>{v.x, v.z, -v.y} : v;
  }
  /// A place, or a velocity.
  template <class R>
  Vec3<R> placed(const Vec3<R>& v) const {
    return turned(v) * static_cast<R>(scale);
  }
  void apply(TriMesh& mesh) const;
  /// Vectors are turned; all values stay in SI units.
  void apply(VertexAttributes& attributes) const;
  /// Places, shift, velocities, and the deformation gradient f_00..f_22 where all of it is there.
  /// Other columns are numbers without a direction, and stay in SI units.
  void apply(ParticleFrame& frame) const;
};

}  // namespace dreampm::exchange
