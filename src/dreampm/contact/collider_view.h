// The colliders near one block of the grid as one solid, as matter inside of the box sees them. A
// face that lies on a closed wall of the box, or on the face of another collider, is no surface:
// matter cannot come there. The distance that a collider's shape knows by itself is that from its
// nearest face, hidden or not; a particle beside a seam would be put back along the seam instead of
// out of the solid.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

/// The signed distance from a surface [cells], negative inside, and its outward normal; 0 more than
/// a slit outside.
struct ColliderDistance {
  double distance;
  Vec3d normal;
};

/// Returns the shifts [m] of a collider's copies on periodic axes; endless colliders have none.
template <class R>
std::vector<Vec3d> periodic_copies(const World<R>& world, const Collider& collider);

/// A collider where it stands, and its copies.
struct PlacedCollider {
  Collider collider;
  std::vector<Vec3d> shifts;  ///< from periodic_copies
  // Asked for once, as distances are asked for often:
  bool moves = collider.moves();
  bool turned = !(collider.surface_pose.rotation == Quaternion{});

  /// Returns Collider::distance [m], to the same bits.
  double distance(const Vec3d& p) const { return collider.shape->distance(in_frame(p)); }
  /// The place in the frame of its shape.
  Vec3d in_frame(const Vec3d& p) const {
    if (!moves) return p;
    return turned ? collider.surface_pose.inverse(p) : p - collider.surface_pose.position;
  }
};

/// Places in cells from the block's first node. What lies behind a closed wall is the mirror image
/// of what lies before it, so that colliders which end on the wall go on behind.
class ColliderView {
 public:
  /// Faces that are less apart than this [cells] leave no room for matter between them.
  static constexpr double slit = 0.15;
  /// Distance before a face [cells] at which it is tested whether matter can come there. Meshes
  /// that end on a wall have edges rounded over as far as their voxels go.
  static constexpr double before_face = 0.4;

  /// The colliders that a view shows: those that stand still, also those in a given motion, or also
  /// rigid bodies.
  enum class See { fixed, driven, all };

  /// `colliders`: all of the world, which must outlive the view.
  template <class R>
  ColliderView(const World<R>& world, const Vec3i& block, const std::vector<PlacedCollider>& colliders, See see);

  /// All of `colliders` without walls around them, in cells of `dx` from `first` [m].
  ColliderView(const std::vector<PlacedCollider>& colliders, const Vec3d& first, double dx);

  /// The same for single colliders alone, such as `distance` and `velocity`: it looks for none that
  /// is near.
  struct SinglesOnly {};
  template <class R>
  ColliderView(const World<R>& world, const Vec3i& block, const std::vector<PlacedCollider>& colliders, SinglesOnly);

  /// A copy that outlives the places of its colliders: it looks at them anew each time.
  ColliderView for_later() const {
    ColliderView copy = *this;
    copy.middle_distances_.clear();
    return copy;
  }

  /// Numbers of the colliders within `reach` cells of the block's middle, in their order.
  std::vector<std::uint16_t> within(double reach) const;
  /// True if that collider, one of those shown, is within reach.
  bool is_within(std::uint16_t collider, double reach) const { return distance(collider, middle) <= reach; }

  /// The distance [cells] from that collider alone, with all of its faces.
  double distance(std::uint16_t collider, const Vec3d& at) const;
  /// The same at many places.
  void distances(std::uint16_t collider, std::span<const Vec3d> at, double* to) const;
  /// The place in the frame of that collider's shape [m], as its nearest copy sees it,
  Vec3d in_frame(std::uint16_t collider, const Vec3d& at) const;
  /// and as each copy does: `body(place)`.
  template <class Body>
  void for_each_frame(std::uint16_t collider, const Vec3d& at, const Body& body) const {
    bool turned[3];
    const Vec3d p = before_walls(at, turned);
    const PlacedCollider& c = (*colliders_)[collider];
    for (const Vec3d& shift : c.shifts) body(c.collider.surface_pose.inverse(p - shift));
  }
  bool holds_matter(std::uint16_t collider) const { return (*colliders_)[collider].collider.holds; }
  bool is_rigid_body(std::uint16_t collider) const { return (*colliders_)[collider].collider.rigid; }
  /// Returns its outward normal there.
  Vec3d normal(std::uint16_t collider, const Vec3d& at) const;
  /// The velocity of its matter there [m/s].
  Vec3d velocity(std::uint16_t collider, const Vec3d& at) const;
  /// The way there from the center of its twist, before the walls [m].
  Vec3d arm(std::uint16_t collider, const Vec3d& at) const;
  /// Returns its spin before the walls [rad/s].
  const Vec3d& spin(std::uint16_t collider) const { return (*colliders_)[collider].collider.twist.spin; }

  /// The distance from the faces of that collider that matter can touch: inside beside a hidden
  /// face it is that from the nearest surface of the whole solid.
  ColliderDistance exposed(std::uint16_t collider, const Vec3d& at) const {
    return exposed(collider, at, distance(collider, at));
  }
  /// The same where its distance is known.
  ColliderDistance exposed(std::uint16_t collider, const Vec3d& at, double distance) const;

  /// Returns the distance from the nearest collider that puts matter back out of it, with its
  /// normal, outside of it too; {reach, 0} where it is more than `reach`.
  ColliderDistance nearest_exposed(const Vec3d& at, double reach) const;

  /// True if matter can lie before the face of a collider at `at` that faces `normal`.
  bool is_exposed(const Vec3d& at, const Vec3d& normal) const { return nearest(at + normal * before_face) > 1e-6; }
  /// The part of a cube around `at` that colliders fill: 1/2 where a surface goes through its
  /// middle. `width` in cells.
  double filled(const Vec3d& at, double width) const;
  /// The distance from the nearest collider,
  double nearest(const Vec3d& at) const;
  /// at many places: there it costs a fraction,
  void nearest(std::span<const Vec3d> at, double* to) const;
  /// and which that is.
  std::uint16_t nearest_collider(const Vec3d& at) const { return nearest_of(near_, at); }

  /// True if matter may come to a place: one that is neither on a wall nor behind it.
  bool within_domain(const Vec3d& at) const;

  /// The distance from the nearest closed wall [cells], negative behind it.
  double before_wall(const Vec3d& at) const;

  /// A rounding error outside an aligned face is inside.
  static bool inside(double distance) { return distance <= 1e-6; }
  /// Returns the point where the line between two places on either side of a surface meets it;
  /// `begin`, `end`: distances there from the surface that lies `out` of the solid.
  Vec3d crossing(const Vec3d& from, const Vec3d& to, double begin, double end, double out = 0) const;

 private:
  /// The place that is the image of `at`, before all closed walls [m]; `turned`: the axes along
  /// which it is mirrored.
  Vec3d before_walls(const Vec3d& at, bool (&turned)[3]) const;
  /// The same of at most `places_at_once`, by axis.
  static constexpr std::size_t places_at_once = 64;
  using Meters = std::array<std::array<double, places_at_once>, 3>;
  PointColumns before_walls(std::span<const Vec3d> at, Meters& meters) const;
  template <class R>
  void set_walls(const World<R>& world, const Vec3i& block);
  bool sees(const Collider& collider) const {
    return !(see_ == See::fixed ? collider.moves() : see_ == See::driven && collider.rigid);
  }
  double distance_at(std::uint16_t collider, const Vec3d& meters) const;
  void distances_at(std::uint16_t collider, const PointColumns& meters, double* to) const;
  /// The first of the nearest of `some`, which are not empty.
  std::uint16_t nearest_of(const std::vector<std::uint16_t>& some, const Vec3d& at) const;
  /// The middle of the block.
  static constexpr Vec3d middle{1.5, 1.5, 1.5};
  /// The nearest surface of the solid around a place inside; -3 cells along `hidden`, the normal of
  /// a hidden face, where there is none within as much.
  ColliderDistance depth(const Vec3d& at, const Vec3d& hidden) const;

  Vec3d first_;  ///< m: the block's first node
  double dx_;
  double low_[3], high_[3];         ///< m: closed walls; endless where there are none
  Vec3d domain_low_, domain_high_;  ///< where matter may be, in cells from the block's first node
  const std::vector<PlacedCollider>* colliders_;
  See see_;
  std::vector<std::uint16_t> near_, near_closed_;  ///< all, and those that do not hold matter inside
  /// Distances of the near_ colliders from the middle of the block [cells]; empty where they may
  /// have changed.
  std::vector<double> middle_distances_;
  std::size_t middle_first_ = 0;  ///< of these the first of the least
};

}  // namespace dreampm
