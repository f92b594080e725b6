// Distances from colliders at many places at once.
#include "dreampm/contact/collider_view.h"

#include <gtest/gtest.h>

#include <vector>

#include "dreampm/math/rng.h"

namespace dreampm {
namespace {

template <class Form>
std::shared_ptr<const Region> made(const Form& form, const Vec3d& center, double degrees) {
  Shape s;
  s.form = form;
  s.center = center;
  s.rotate_axis = {1, 3, 2}, s.rotate_angle = degrees;
  return make_region(s, 0.01, {});
}

/// A box that stands, a box that has turned and moved on, a ball that goes through a periodic end.
World<float> world_of() {
  World<float> w;
  w.dx = 0.1;
  w.origin = {1, 2, 3};
  w.low = {0, 0, 0}, w.high = {32, 24, 24};
  w.periodic = {true, false, false};
  Collider stands{"stands", made(BoxShape{{0.7, 0.5, 0.9}}, {2.4, 2.2, 3.3}, 0), WallType::separate, 0};
  Collider turned{"turned", made(BoxShape{{0.4, 0.8, 0.3}}, {2.6, 3, 3.8}, 20), WallType::separate, 0};
  turned.pose = turned.surface_pose = {{0.1, 2.2, -0.9}, Quaternion::about({0.4, 0.1, -0.3})};
  Collider ball{"ball", made(SphereShape{0.4}, {1.1, 2.6, 3.4}, 0), WallType::separate, 0};
  ball.pose = ball.surface_pose = {{0.02, 0.1, 0.3}, {}};
  w.colliders = {stands, turned, ball};
  return w;
}

// Within the box, behind its walls and beyond, where images are mirrored again.
TEST(ColliderView, FindsTheSameAtManyPlacesAsAtOne) {
  const World<float> w = world_of();
  std::vector<PlacedCollider> placed;
  for (const Collider& c : w.colliders) placed.push_back({c, periodic_copies(w, c)});
  std::size_t behind = 0, inside = 0;
  for (const Vec3i& block : {Vec3i{0, 0, 0}, Vec3i{3, 0, 1}, Vec3i{7, 5, 5}}) {
    const ColliderView view(w, block, placed, ColliderView::See::all);
    std::vector<Vec3d> places;
    for (std::uint64_t n = 0; n < 150; ++n)
      places.push_back(Vec3d{uniform(3, 3 * n), uniform(3, 3 * n + 1), uniform(3, 3 * n + 2)} * 14.0 - Vec3d{5, 5, 5});
    std::vector<double> nearest(places.size()), one(places.size());
    view.nearest(places, nearest.data());
    for (std::size_t n = 0; n < places.size(); ++n) {
      ASSERT_EQ(nearest[n], view.nearest(places[n])) << n;
      behind += view.before_wall(places[n]) < 0, inside += nearest[n] < 0;
    }
    for (std::uint16_t c = 0; c < 3; ++c) {
      view.distances(c, places, one.data());
      for (std::size_t n = 0; n < places.size(); ++n) ASSERT_EQ(one[n], view.distance(c, places[n])) << c << ' ' << n;
    }
  }
  EXPECT_GT(behind, 50u);
  EXPECT_GT(inside, 20u);
}

// A box stands on the floor: below its middle the nearest face lies behind the floor, where matter
// cannot come. What counts is the way out along the floor, which goes at right angles to a side.
TEST(ColliderView, GoesOutOfASolidWhereMatterCanBe) {
  World<float> w;
  w.dx = 0.1;
  w.low = {0, 0, 0}, w.high = {32, 32, 32};
  w.colliders = {{"block", made(BoxShape{{0.5, 0.64, 0.5}}, {1.6, 0.3, 1.6}, 0), WallType::separate, 0}};
  const std::vector<PlacedCollider> placed{{w.colliders[0], periodic_copies(w, w.colliders[0])}};
  const ColliderView view(w, {3, 0, 3}, placed, ColliderView::See::all);
  for (const double aside : {1.2, 1.7, 2.3}) {  // cells from the middle
    const Vec3d at{4 + aside, 0.1, 4};
    ASSERT_NEAR(view.distance(0, at), -std::min(0.3, 2.5 - aside), 1e-6);
    const ColliderDistance out = view.exposed(0, at);
    EXPECT_NEAR(out.distance, -(2.5 - aside), 1e-5) << aside;
    EXPECT_NEAR(out.normal.x, 1, 1e-5) << aside;
  }
}

}  // namespace
}  // namespace dreampm
