// Thin lines: edges of the domain, the ring of the brush, segments.
#pragma once
#include <vector>

#include "dreampm/gl/objects.h"
#include "dreampm/gl/picture.h"

namespace dreampm::gl {

class LinePass {
 public:
  /// Which edges of the domain, seen from an eye outside: those behind all that is in it, or the
  /// others.
  enum class Edges { all, behind, before };
  void draw_outline(const Picture& picture, const Vec3f& eye, Edges edges);
  /// Segments and ring.
  void draw_marks(const Picture& picture);

 private:
  void add(const LineSegment& segment);
  void flush(float width);

  std::vector<Vec3f> from_, to_;
  std::vector<std::array<std::uint8_t, 4>> color_;
  Buffer from_buffer_, to_buffer_, color_buffer_;
  VertexArray vertices_;
  Program program_{"lines.vert", "lines.frag"};
};

}  // namespace dreampm::gl
