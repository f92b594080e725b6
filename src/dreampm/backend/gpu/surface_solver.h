// Contact with the surfaces of colliders at nodes in a device's memory, in place of SurfaceContact.
// The host solves for the velocities of rigid bodies, from sums over their points.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/backend/body_coupling.h"
#include "dreampm/backend/gpu/gap_measure.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/backend/surface_contact.h"

namespace dreampm::gpu {

class SurfaceSolver {
 public:
  explicit SurfaceSolver(Device& device);
  /// Must be called after the same of `host`: after every change of the grid's block list or of
  /// colliders.
  void prepare(const World<float>& world, const Obstacles& obstacles, const SurfaceContact<float>& host,
               const ContactGaps& gaps);
  /// Must be called instead where the velocities of colliders alone have changed.
  void set_velocities(const World<float>& world, const Obstacles& obstacles, const SurfaceContact<float>& host);
  /// Contact of all fields in a step of `dt` [s]. `bodies`: whether rigid bodies are unknowns, as
  /// in the visit of a step, not in a stage.
  void operator()(const VisitInput& in, const World<float>& world, const GapMeasure& gaps, double dt, bool bodies);
  /// What colliders gave, and the ranges of it that belong together.
  const SourceTerms* given() const { return given_.data(); }
  const Buffer<Range>& ranges() const { return ranges_; }
  /// The collider of a range.
  std::size_t collider_of(std::size_t range) const { return static_cast<std::size_t>(collider_of_range_[range]); }

 private:
  void find_points(const Obstacles& obstacles, const SurfaceContact<float>& host, const ContactGaps& gaps);
  void find_nodes(const SurfaceContact<float>& host);
  void find_groups(std::size_t colliders, const SurfaceContact<float>& host);
  void find_bodies(const World<float>& world);
  void solve_field(const SurfaceInput& all, bool bodies);
  void solve_bodies(const SurfaceInput& all);
  void send_bodies();
  SurfaceInput input(const VisitInput& in, const World<float>& world, const GapMeasure& gaps, double dt,
                     std::size_t field) const;

  Device* device_;
  bool moves_ = false;
  std::vector<ContactPoint> points_home_;
  std::vector<ContactNode> nodes_home_;
  Buffer<ContactPoint> points_;
  Buffer<PointBlock> blocks_;
  Buffer<std::uint32_t> node_blocks_, first_, first_group_;
  Buffer<ContactNode> nodes_;
  Buffer<PointOfNode> points_of_;
  Buffer<CollidingMatter> colliders_;
  Buffer<SurfaceGroup> groups_;
  Buffer<Range> ranges_;
  std::vector<std::int32_t> collider_of_range_;
  // Rigid bodies: their points, those of one together, and what these add up to.
  BodyCoupling coupling_;
  Buffer<std::uint32_t> body_points_;
  Buffer<Range> body_ranges_;
  std::vector<std::size_t> body_of_range_;
  Buffer<BodySums> body_sums_;
  std::vector<BodySums> body_sums_home_;
  Buffer<BodyMotion> motions_;
  std::vector<BodyMotion> motions_home_;
  // Of one solve.
  Buffer<PointState> point_states_;
  Buffer<Vec3<float>> changes_;
  Buffer<float> velocity_weights_, inverse_masses_;
  Buffer<NodeState> node_states_;
  Buffer<std::int32_t> fastest2_;
  Buffer<SourceTerms> given_;
};

}  // namespace dreampm::gpu
