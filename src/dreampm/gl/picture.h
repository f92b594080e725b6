// What a picture shows, as plain values. Lengths are in meters, +y is up; all colors are sRGB, 0 to
// 1, as a color picker shows them. Spans need to live only until the call that draws them is back.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "dreampm/math/vec.h"
#include "dreampm/pose.h"

namespace dreampm::gl {

/// What the look "water" needs to know of a clear or cloudy liquid.
struct Liquid {
  Vec3f absorption{6.0f, 1.7f, 0.5f};  ///< 1/m: light in the liquid falls as exp(-absorption path)
  Vec3f tint{0.20f, 0.58f, 0.74f};     ///< the color of what it scatters back
  float cloudiness = 1.6f;             ///< 1/m: what shows behind a path falls as exp(-cloudiness path)
  float refractive_index = 1.333f;     ///< from 1 to 3
};

/// Particles that look alike.
struct ParticleBatch {
  std::span<const Vec3f> position;
  /// One a particle, or empty: colors by the color scale (color_scale.h), from the first color at
  /// value_min to the last at value_max.
  std::span<const float> value;
  float value_min = 0, value_max = 1;
  /// Red green blue alpha, one a particle, or empty; goes before `value`. Alpha is not looked at.
  std::span<const std::array<std::uint8_t, 4>> color;
  Vec3f base_color{0.75f, 0.75f, 0.78f};  ///< of all, where there is neither value nor color
  /// 0 to 1; below 1 what is nearest is blended over what lies behind the batch. Liquids have
  /// `liquid` instead.
  float opacity = 1;
  float radius = 0.01f;               ///< of the spheres, > 0
  float spacing = 0;                  ///< mean distance of neighbors, for the depth of liquids; 0: radius / 0.8
  std::string_view look = "spheres";  ///< one of look_names()
  Liquid liquid{};                    ///< for the look "water"
};

/// A rigid surface: a collider or a body.
struct MeshBatch {
  std::span<const Vec3f> vertices;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const Vec3f> normals;  ///< one a vertex; or empty: flat faces
  Pose pose{};
  Vec3f color{0.7f, 0.7f, 0.7f};
  float opacity = 1;  ///< 0 to 1; below 1 it is blended over what lies behind
  /// Vertices, triangles and normals are copied to the driver again whenever one of the spans or
  /// this number is another than at the last frame.
  std::uint64_t revision = 0;
};

struct LineSegment {
  Vec3f from, to;
  Vec3f color{1, 1, 1};
  float opacity = 1;
};

/// The ring that shows where a brush acts.
struct BrushRing {
  Vec3f center, normal{0, 1, 0};
  float radius = 0.05f;
  Vec3f color{1.0f, 0.75f, 0.2f};
};

struct PointLight {
  Vec3f position;
  Vec3f color{1, 1, 1};  ///< brightness, the same at every distance
};

/// Colors of all that is not matter.
struct Theme {
  Vec3f background_low, background_high;        ///< at the horizon, and above
  Vec3f sky_low, sky_high;                      ///< what wet surfaces reflect
  Vec3f ambient_low, ambient_high;              ///< light from below and from above
  Vec3f floor_bright, floor_dark, floor_grout;  ///< two kinds of tiles, and what is between
  Vec3f outline;                                ///< edges of the domain
};
Theme light_theme();
Theme dark_theme();

struct Floor {
  bool shown = true;
  float height = 0;   ///< y
  float tile = 0.1f;  ///< side of a tile, > 0
};

struct Picture {
  std::span<const ParticleBatch> particles;
  std::span<const MeshBatch> meshes;
  std::span<const LineSegment> segments;
  std::optional<BrushRing> ring;
  Box3f domain{{0, 0, 0}, {1, 1, 1}};  ///< the box of the scene
  bool outline = true;                 ///< draw its edges
  Floor floor{};
  /// The first throws shadows; it has to be above the domain.
  std::array<PointLight, 2> lights{PointLight{{2.3f, 3.0f, 1.3f}, {0.95f, 0.93f, 0.88f}},
                                   PointLight{{-1.5f, 1.6f, 2.4f}, {0.42f, 0.45f, 0.52f}}};
  Theme theme = light_theme();
};

/// Lights that stand to another box as the default ones stand to the unit box.
std::array<PointLight, 2> lights_for(const Box3f& domain);

}  // namespace dreampm::gl
