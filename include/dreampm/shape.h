// A shape, as a scene file has it.
#pragma once
#include <string>
#include <utility>

#include "dreampm/vec.h"

namespace dreampm {

/// A shape, as a scene file has it.
class SceneShape {
 public:
  static SceneShape box(const Vec3d& min, const Vec3d& max);     ///< corners [m]
  static SceneShape sphere(const Vec3d& center, double radius);  ///< m
  /// Upright.
  static SceneShape cylinder(const Vec3d& center, double radius, double height);  ///< m
  /// Anything that stands behind `shape:` in a scene file: "{mesh: bunny.ply, fit: {longest:
  /// 0.3}}".
  static SceneShape yaml(std::string text);
  const std::string& text() const { return text_; }

 private:
  explicit SceneShape(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

}  // namespace dreampm
