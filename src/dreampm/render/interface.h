// What happens to light at a clear surface: water, pane or glass edge. Where clear objects overlap,
// the one of the highest rank is there and hides the faces of the others (Schmidt and Budge 2002,
// "Simple nested dielectrics in ray traced images").
#pragma once
#include <array>

#include "dreampm/render/intersect.h"

namespace dreampm::trace {

/// The clear objects around a point, and when.
class Media {
 public:
  float time = 0.5f;  ///< through the exposure, 0 to 1
  /// The object that is there, or air.
  int top() const { return size_ == 0 ? air : objects_[static_cast<std::size_t>(size_ - 1)]; }
  /// Once, whether it was there or not. Of more than seven those of the lowest rank are forgotten.
  void add(const Geometry& geometry, int object);
  void remove(int object);

 private:
  std::array<std::int16_t, 7> objects_{};  ///< by rank; small, since every path has its own
  std::int16_t size_ = 0;
};

/// The part of cast_visible for a `hit` on clear matter or on the floor under it.
void pass_hidden(const Geometry& geometry, Vec3f o, const Vec3f& d, Media& media, Hit& hit, float reach,
                 PassedGrains* passed);

/// The nearest surface that matters along a ray, as Geometry::cast, past faces that an object of a
/// higher rank hides. `media` is what the ray is in at o; afterwards what it is in just before the
/// surface, which the surface's side decides where both disagree.
inline Hit cast_visible(const Geometry& geometry, const Vec3f& o, const Vec3f& d, Media& media, float reach = 1e9f,
                        PassedGrains* passed = nullptr) {
  Hit hit = geometry.cast(o, d, media.top(), media.time, reach, passed);
  if (hit.object != air && hit.kind != Kind::opaque) pass_hidden(geometry, o, d, media, hit, reach, passed);
  return hit;
}

/// Of what is there: 1 in air.
float ior(const Geometry& geometry, const Media& media);
/// `media` on the other side of a dielectric's face.
Media across(const Geometry& geometry, const Hit& hit, Media media);

struct Split {
  float reflectance = 0;  ///< share reflected; 1 under total reflection
  Vec3f tint{1, 1, 1};    ///< of what passes
  Vec3f reflected, refracted;
  Media refracted_media;
  Vec3f side;  ///< the face's normal on the side that the ray came from
};

/// At a dielectric, pane or bar; `media` is what the ray came through.
Split split_light(const Geometry& geometry, const Hit& hit, const Vec3f& d, const Media& media);

/// What a bar lets through along a straight line.
inline constexpr Vec3f bar_shade{0.50f, 0.75f, 0.68f};
inline constexpr Vec3f pane_tint{0.97f, 0.985f, 0.98f};

}  // namespace dreampm::trace
