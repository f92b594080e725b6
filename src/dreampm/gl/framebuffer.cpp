#include "dreampm/gl/framebuffer.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/gl/objects.h"

namespace dreampm::gl {

struct Framebuffer::Impl {
  Texture color{Texel::rgba8, Texture::Filter::linear};
  Texture depth{Texel::depth, Texture::Filter::nearest};
  Target both{&color, &depth};
  Target color_only{&color};
};

Framebuffer::Framebuffer(int width, int height) : impl_(std::make_unique<Impl>()) { resize(width, height); }
Framebuffer::~Framebuffer() = default;
Framebuffer::Framebuffer(Framebuffer&&) noexcept = default;
Framebuffer& Framebuffer::operator=(Framebuffer&&) noexcept = default;

void Framebuffer::resize(int width, int height) {
  GLint texture = 0, buffer = 0, viewport[2] = {0, 0};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &buffer);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  const int most = std::min({widest_framebuffer, texture, buffer, viewport[0], viewport[1]});
  if (width < 1 || height < 1 || width > most || height > most)
    fail_input("a picture of {} x {} pixels cannot be drawn: each side has to be from 1 to {}{}", width, height, most,
               most < widest_framebuffer ? ", the limit of this machine's OpenGL" : "");
  impl_->color.resize(width, height);
  impl_->depth.resize(width, height);
}

int Framebuffer::width() const { return impl_->color.width(); }
int Framebuffer::height() const { return impl_->color.height(); }
const Texture& Framebuffer::color() const { return impl_->color; }
const Texture& Framebuffer::depth() const { return impl_->depth; }
const Target& Framebuffer::target() const { return impl_->both; }
const Target& Framebuffer::color_only() const { return impl_->color_only; }

RgbImage Framebuffer::read() const {
  RgbImage image(width(), height());
  impl_->color_only.bind();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width(), height(), GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
  check_errors("reading a picture");
  const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(width());
  for (int y = 0; y < height() / 2; ++y)
    std::swap_ranges(image.at(0, y), image.at(0, y) + row, image.at(0, height() - 1 - y));
  return image;
}

}  // namespace dreampm::gl
