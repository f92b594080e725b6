// The pressure of a projection's cells, between their centers.
#pragma once
#include "dreampm/state/world.h"

namespace dreampm {

/// The pressure of a world that a projection steps, and that must outlive this object. It is the
/// mean over the last step, which is the pressure in the middle of that step.
template <class R>
class CellPressure {
 public:
  explicit CellPressure(const World<R>& world) : world_(world) {}

  /// Pa, of one cell. 0: there is no liquid.
  double of_cell(const Vec3i& cell) const;
  /// Pa, at a scene position [m], trilinear among the centers around it. Where some of these hold
  /// no liquid, the others go on by their slopes: what is linear is exact up to walls, colliders
  /// and surfaces. 0 where no liquid is around.
  double at(const Vec3d& position) const;

 private:
  /// Returns the pressure that a cell of liquid, of pressure `own`, gives for a place `way` cells
  /// from its center.
  double from(const Vec3i& cell, double own, const Vec3d& way) const;

  const World<R>& world_;
};

}  // namespace dreampm
