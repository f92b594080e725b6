#include "dreampm/gl/headless.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "dreampm/base/error.h"

namespace dreampm::gl {

struct HeadlessContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  ~Impl() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
  }
};

namespace {

constexpr const char* remedy = "install a driver (Debian: libegl1 and libgl1-mesa-dri)";

EGLDisplay open_display() {
  // Mesa's surfaceless platform needs no device; other drivers offer their devices.
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base"))
    if (const EGLDisplay d = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        d != EGL_NO_DISPLAY && eglInitialize(d, nullptr, nullptr))
      return d;
  if (const EGLDisplay d = eglGetDisplay(EGL_DEFAULT_DISPLAY);
      d != EGL_NO_DISPLAY && eglInitialize(d, nullptr, nullptr))
    return d;
  fail_run("EGL gives no display to draw without a window: {}", remedy);
}

}  // namespace

HeadlessContext::HeadlessContext() : impl_(std::make_unique<Impl>()) {
  if (!epoxy_has_egl()) fail_run("there is no EGL to draw without a window: {}", remedy);
  impl_->display = open_display();
  if (!epoxy_has_egl_extension(impl_->display, "EGL_KHR_surfaceless_context"))
    fail_run("this machine's EGL cannot draw without a surface (EGL_KHR_surfaceless_context): {}", remedy);
  if (!eglBindAPI(EGL_OPENGL_API)) fail_run("this machine's EGL has no OpenGL: {}", remedy);
  const EGLint wish[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config{};
  EGLint count = 0;
  if (!eglChooseConfig(impl_->display, wish, &config, 1, &count) || count == 0)
    fail_run("this machine's EGL has no configuration for OpenGL: {}", remedy);
  const EGLint version[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  impl_->context = eglCreateContext(impl_->display, config, EGL_NO_CONTEXT, version);
  if (impl_->context == EGL_NO_CONTEXT) fail_run("no OpenGL 3.3 here (EGL error 0x{:04x}): {}", eglGetError(), remedy);
  if (!eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context))
    fail_run("the context of OpenGL cannot be used (EGL error 0x{:04x})", eglGetError());
  require_opengl_3_3();
}

HeadlessContext::~HeadlessContext() = default;

std::string HeadlessContext::driver() const {
  return fmt::format("{}, OpenGL {}", reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
                     reinterpret_cast<const char*>(glGetString(GL_VERSION)));
}

void require_opengl_3_3() {
  if (const int version = epoxy_gl_version(); version < 33 || !epoxy_is_desktop_gl())
    fail_run("this machine has OpenGL {}.{}, and 3.3 is needed: {}", version / 10, version % 10, remedy);
}

}  // namespace dreampm::gl
