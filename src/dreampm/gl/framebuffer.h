// What a picture is drawn into.
#pragma once
#include <memory>

#include "dreampm/image.h"

namespace dreampm::gl {

class Texture;
class Target;

inline constexpr int widest_framebuffer = 8192;  ///< pixels a side

/// Color (8 bits a channel) and depth, width x height pixels.
class Framebuffer {
 public:
  /// Throws InputError unless both sides are from 1 to 8192 and to what this machine's OpenGL can.
  Framebuffer(int width, int height);
  ~Framebuffer();
  Framebuffer(Framebuffer&&) noexcept;
  Framebuffer& operator=(Framebuffer&&) noexcept;

  /// The content is undefined afterwards. Throws as the constructor does, and is then unchanged.
  void resize(int width, int height);
  int width() const;
  int height() const;

  /// The picture, rows from the top. Waits until it is drawn.
  RgbImage read() const;

  const Texture& color() const;      ///< row 0 at the bottom
  const Texture& depth() const;      ///< as the projection of the camera gives it, 0 to 1
  const Target& target() const;      ///< color and depth
  const Target& color_only() const;  ///< for passes that read the depth

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dreampm::gl
