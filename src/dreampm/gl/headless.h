// OpenGL without a window.
#pragma once
#include <memory>
#include <string>

namespace dreampm::gl {

/// A context of OpenGL 3.3 core without a surface (EGL), current in the thread that made it for as
/// long as it lives. Draw into a Framebuffer.
class HeadlessContext {
 public:
  /// Throws RunError where there is no EGL, or no OpenGL 3.3.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

  /// Who draws, and the version of OpenGL, as the driver names them.
  std::string driver() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Throws RunError unless the current context, made by whatever window, has OpenGL 3.3 or newer.
void require_opengl_3_3();

}  // namespace dreampm::gl
