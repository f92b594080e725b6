#include "dreampm/gl/line_pass.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dreampm::gl {

namespace {
std::uint8_t byte_of(float c) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(c, 0.0f, 1.0f))); }
}  // namespace

void LinePass::add(const LineSegment& s) {
  if (!is_finite(s.from) || !is_finite(s.to)) return;
  from_.push_back(s.from);
  to_.push_back(s.to);
  color_.push_back({byte_of(s.color.x), byte_of(s.color.y), byte_of(s.color.z), byte_of(s.opacity)});
}

void LinePass::flush(float width) {
  if (from_.empty()) return;
  from_buffer_.fill(from_.data(), from_.size() * sizeof(Vec3f));
  to_buffer_.fill(to_.data(), to_.size() * sizeof(Vec3f));
  color_buffer_.fill(color_.data(), color_.size() * sizeof(color_[0]));
  vertices_.floats(0, from_buffer_, 3);
  vertices_.floats(1, to_buffer_, 3);
  vertices_.bytes(2, color_buffer_);
  for (GLuint input = 0; input < 3; ++input) glVertexAttribDivisor(input, 1);
  program_.use();
  program_.set("half_width", 0.5f * width);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(from_.size()));
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  from_.clear();
  to_.clear();
  color_.clear();
}

void LinePass::draw_outline(const Picture& picture, const Vec3f& eye, Edges edges) {
  if (!picture.outline || picture.domain.empty()) return;
  // Whether a side of the box shows its outside.
  const auto faces_eye = [&](int axis, bool high) {
    return high ? eye[axis] > picture.domain.max[axis] : eye[axis] < picture.domain.min[axis];
  };
  const auto corner = [&](int k) {
    const Box3f& b = picture.domain;
    return Vec3f{(k & 1) ? b.max.x : b.min.x, (k & 2) ? b.max.y : b.min.y, (k & 4) ? b.max.z : b.min.z};
  };
  for (int k = 0; k < 8; ++k)
    for (int along = 0; along < 3; ++along) {
      if (k & (1 << along)) continue;
      const int a = (along + 1) % 3, b = (along + 2) % 3;
      const bool behind = !faces_eye(a, k & (1 << a)) && !faces_eye(b, k & (1 << b));
      if (edges == Edges::all || behind == (edges == Edges::behind))
        add({corner(k), corner(k | 1 << along), picture.theme.outline, 0.55f});
    }
  flush(1.2f);
}

void LinePass::draw_marks(const Picture& picture) {
  for (const LineSegment& s : picture.segments) add(s);
  if (picture.ring) {
    const BrushRing& ring = *picture.ring;
    const Vec3f n = normalized(ring.normal);
    const Vec3f u = normalized(cross(std::fabs(n.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0}, n)), v = cross(n, u);
    constexpr int parts = 64;
    const auto at = [&](int k) {
      const float a = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / parts;
      return ring.center + (u * std::cos(a) + v * std::sin(a)) * ring.radius;
    };
    for (int k = 0; k < parts; ++k) add({at(k), at(k + 1), ring.color, 0.95f});
  }
  flush(2.0f);
}

}  // namespace dreampm::gl
