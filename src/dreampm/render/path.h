// A path of light on its way, and what it meets.
#pragma once
#include <array>

#include "dreampm/render/color.h"
#include "dreampm/render/interface.h"
#include "dreampm/render/surfaces.h"

namespace dreampm::trace {

/// Below this weight paths go on by lot.
inline constexpr float weak = 0.02f;

struct Path {
  Vec3f o, d, weight{1, 1, 1};
  Media media;
  int bounces = 0;
  float distance = 0;
  bool sun_disc = true;
  bool polished = false;     ///< no further reflection in the floor's polish
  bool gathered = false;     ///< the last surface gathered photons, and was no mirror
  bool sky_counted = false;  ///< the last surface was lit by the sky directly, as far as d sees it straight on
  int scatterings = 0;       ///< in cloudy matter so far
  float clear = 0;           ///< m: within that no surface is around o, while it is in cloudy matter
};

/// Paths that are still to be followed.
struct PathStack {
  std::array<Path, 16> paths;
  std::size_t size = 0;
  bool room() const { return size < paths.size(); }
};

/// A point of a surface that a path met.
struct Shading {
  Vec3f p, n, face;  ///< m; both normals on the path's side
  Frame frame;       ///< about n
  Vec3f view;        ///< in the frame
  Vec3f color;
  const Bsdf& bsdf;
};

/// How far a path goes in cloudy matter.
struct FreePath {
  float length = 1e9f;   ///< m
  Vec3f share{1, 0, 0};  ///< with which chance each channel chose it
};

}  // namespace dreampm::trace
