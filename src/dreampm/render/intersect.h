// The nearest surface that a ray meets: Embree for meshes and spheres, planes by hand for panes and
// floor. A face of the water that lies on a wall plane stands for water, glass and air in one
// event, so there is never a false gap of air nor a fight of coplanar faces.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "dreampm/render/color.h"
#include "dreampm/render/looks.h"
#include "dreampm/render/render.h"

struct RTCGeometryTy;

namespace dreampm::trace {

inline constexpr int air = -1;
inline constexpr unsigned no_shape = ~0u;

struct EmbreeScene;
struct TracedShape;

enum class Kind : std::uint8_t { none, dielectric, opaque, bar, pane, floor };

struct Hit {
  float t = 1e9f;  ///< m
  Kind kind = Kind::none;
  bool back = false;                         ///< met from inside
  bool glass = false;                        ///< a dielectric's face behind a pane
  int object = air;                          ///< index into the scene's objects
  Vec3f normal, geometric;                   ///< outward, unit length: for shading, of the face itself
  Vec3f color;                               ///< of opaque surfaces, that of their look or their own
  float grain = 0;                           ///< m: the radius of the grain that was met; 0: none
  float opacity = 1;                         ///< of a grain
  Vec3f center{};                            ///< m, of a grain
  Vec3f moved{};                             ///< m: how far the place has moved since the middle of the exposure
  unsigned shape = no_shape, primitive = 0;  ///< of Embree; no_shape of panes and of the open floor
  float u = 0, v = 0;                        ///< on the triangle
};

/// The grains that a ray passes on its way, gathered while it looks for its first hit.
struct PassedGrains {
  struct Met {
    float t, left;  ///< m, and what the grain leaves of the light
    unsigned grain;
  };
  std::array<Met, 64> met;
  std::size_t count = 0;
  float left = 1;         ///< of those that are nearer than all first hits so far
  std::uint32_t lot = 0;  ///< if not 0, each is met instead, or not, with a chance of its opacity
};

class Geometry {
 public:
  /// Builds the tree. Throws InputError for a broken mesh, RunError if Embree fails.
  explicit Geometry(const RenderScene& scene);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  /// `medium`: the object that the ray runs in, or air. d has unit length. `time`: through the
  /// exposure, 0 to 1. Nothing further than `reach` [m] is met.
  /// With `passed`, its `left` is dimmed by the grains before what is met; of these there may be
  /// one, where there were too many to note.
  Hit cast(const Vec3f& o, const Vec3f& d, int medium, float time, float reach = 1e9f,
           PassedGrains* passed = nullptr) const;
  /// Returns m: nothing that a ray in clear matter may meet lies nearer to p; at most `most`. 0
  /// where anything moves within the exposure.
  float clearance(const Vec3f& p, float most) const;
  /// m/s, of what was hit, in the middle of the exposure.
  Vec3f velocity(const Hit& hit) const;
  /// True if anything is at different places within the exposure.
  bool moves() const { return moves_; }
  bool has_grains() const { return has_grains_; }
  /// Everything but the floor.
  const Box3f& bounds() const { return bounds_; }
  /// Does the ray from o along d meet bounds()?
  bool meets_bounds(const Vec3f& o, const Vec3f& d) const;
  /// Rays start this far from a surface [m].
  float epsilon() const { return epsilon_; }
  float floor_y() const { return floor_y_; }
  int objects() const { return static_cast<int>(looks_.size()); }
  const Look& look(int object) const { return *looks_[static_cast<std::size_t>(object)]; }
  /// Of an object that is clear or cloudy, else null; null for air.
  const Interior* interior(int object) const {
    return object == air ? nullptr : interiors_[static_cast<std::size_t>(object)];
  }
  /// What clear matter leaves of the light over t [m] from o along d; all of it in air.
  Vec3f left(int object, const Vec3f& o, const Vec3f& d, float t) const {
    if (object == air) return {1, 1, 1};
    const auto i = static_cast<std::size_t>(object);
    return fields_[i] != nullptr ? fields_[i]->left(o, d, t) : transmission(interiors_[i]->extinction, t);
  }
  /// The glow of clear matter of which a way of t [m] left that much.
  Vec3f glow(int object, const Vec3f& left, float t) const {
    const auto i = static_cast<std::size_t>(object);
    if (fields_[i] == nullptr || !(t > 0)) return interiors_[i]->glow;
    const auto mean = [t](float share) { return -std::log(std::max(1e-30f, share)) / t; };
    return glow_of({mean(left.x), mean(left.y), mean(left.z)});
  }
  const TextureFrame& frame(int object) const { return frames_[static_cast<std::size_t>(object)]; }
  /// Of overlapping objects that of the highest rank is there.
  int rank(int object) const { return ranks_[static_cast<std::size_t>(object)]; }

 private:
  /// `mesh`: that of `from`, or what stands for it.
  void add_mesh(const TriMesh& mesh, const RenderObject& from, int object);
  void set_motion(const TriMesh& mesh, const RenderObject& from, TracedShape& shape, int object);
  /// Where a vertex at p goes, by walls.
  Vec3f carried(const Vec3f& p, const Vec3f& way) const;
  void add_spheres(const RenderSpheres& spheres, int object);
  void add_grains(const RenderGrains& grains, int object);
  template <class Radius>
  void add_points(RTCGeometryTy* g, std::span<const Vec3f> positions, const Radius& radius, TracedShape shape);
  void add_bars();
  void attach(RTCGeometryTy* g, TracedShape shape);
  int wall_of(const Vec3f& a, const Vec3f& b, const Vec3f& c) const;
  Hit first_of(const Vec3f& o, const Vec3f& d, int medium, float time, float reach, PassedGrains* passed) const;
  void cast_panes(const Vec3f& o, const Vec3f& d, Hit& hit, int wall) const;

  std::unique_ptr<EmbreeScene> embree_;
  std::vector<TracedShape> shapes_;                 ///< by Embree's geometry number
  std::vector<std::unique_ptr<const Look>> looks_;  ///< these six by object
  std::vector<const Interior*> interiors_;
  std::vector<const AbsorptionField*> fields_;
  std::vector<Vec3f> colors_;
  std::vector<TextureFrame> frames_;
  std::vector<int> ranks_;
  Box3f basin_, bounds_;
  std::array<bool, 6> is_wall_;
  bool has_floor_, has_glass_;
  float floor_y_, scale_, epsilon_;
  float open_;  ///< s, how long a picture is exposed
  bool moves_ = false, has_grains_ = false;
};

}  // namespace dreampm::trace
