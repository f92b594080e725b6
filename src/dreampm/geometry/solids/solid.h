// Closed forms that are given by a few lengths, such as boxes. A kind is a file of this folder, its
// line in the list below, its struct in dreampm/shape.h and its row in scene/shapes.cpp.
#pragma once
#include <memory>
#include <variant>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/geometry/region.h"
#include "dreampm/shape.h"

namespace dreampm {

/// All that is asked of such a form, about its own center.
class Solid {
 public:
  virtual ~Solid() = default;
  virtual std::shared_ptr<const Region> region() const = 0;
  virtual double volume() const = 0;  ///< m^3
  virtual TriMesh mesh() const = 0;   ///< closed, its triangles counter-clockwise seen from outside
  /// Points of a rigid body by which others meet it first; of round forms points of their rims.
  virtual std::vector<Vec3d> corners() const = 0;
};

// The kinds. Each throws InputError for a length that is not above 0.
std::unique_ptr<const Solid> solid(const BoxShape& form);
std::unique_ptr<const Solid> solid(const SphereShape& form);
std::unique_ptr<const Solid> solid(const CylinderShape& form);

template <class Form>
concept IsSolid = requires(const Form& form) { solid(form); };

/// Null for planes, meshes, clouds, combinations and containers.
inline std::unique_ptr<const Solid> solid_of(const Shape& shape) {
  return std::visit(
      [](const auto& form) -> std::unique_ptr<const Solid> {
        if constexpr (IsSolid<decltype(form)>)
          return solid(form);
        else
          return nullptr;
      },
      shape.form);
}

}  // namespace dreampm
