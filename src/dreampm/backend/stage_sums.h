// The sums of the stages of a sub-cycled step.
#pragma once
#include "dreampm/backend/backend.h"

namespace dreampm {

class StageSums {
 public:
  /// `found`: of the nodes before the stages.
  void begin(std::size_t colliders, const GridStats& found) {
    *this = {};
    kinetic_before_ = found.kinetic;
    contact_.colliders.resize(colliders), all_.colliders.resize(colliders);
  }
  /// Takes the sums of a stage, the work of gravity and stress in it [J], and the part of the stage
  /// before that it keeps: so it keeps that part of its impulses.
  void add(GridStats stage, double work, double kept) {
    last_ = std::move(stage);
    external_work_ += work;
    const auto add_one = [&](ImpulseSum& moved, ImpulseSum& all, const ImpulseSum& given) {
      moved = {moved.impulse * kept + given.impulse, moved.angular * kept + given.angular,
               moved.work * kept + given.work};
      all += moved;
    };
    for (std::size_t side = 0; side < 6; ++side) add_one(contact_.walls[side], all_.walls[side], last_.walls[side]);
    for (std::size_t c = 0; c < last_.colliders.size(); ++c)
      add_one(contact_.colliders[c], all_.colliders[c], last_.colliders[c]);
  }
  /// Brings `found` up to date, and returns the heat of viscosity [J].
  double end(GridStats& found) const {
    found.kinetic = last_.kinetic;
    found.finite = found.finite && last_.finite;
    for (std::size_t side = 0; side < 6; ++side) found.walls[side] += all_.walls[side];
    for (std::size_t c = 0; c < found.colliders.size(); ++c) found.colliders[c] += all_.colliders[c];
    return kinetic_before_ - last_.kinetic + external_work_ + all_.contact().work;
  }

 private:
  GridStats last_;
  GridStats contact_;  ///< impulses of contact in the last stage, with the part of earlier ones that it keeps
  GridStats all_;      ///< impulses of contact, summed over all stages
  double kinetic_before_ = 0, external_work_ = 0;  ///< J
};

}  // namespace dreampm
