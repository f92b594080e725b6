#include "dreampm/play/window.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/play/app.h"
#include "dreampm/play/keys.h"
#include "dreampm/play/worker.h"
#include "dreampm/version.h"

namespace dreampm::play {
namespace {

/// GLFW, and what it said last.
class Glfw {
 public:
  Glfw() {
    glfwSetErrorCallback([](int, const char* text) { last_error() = text; });
    if (!glfwInit()) fail("no window can be opened");
  }
  ~Glfw() { glfwTerminate(); }
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;

  [[noreturn]] static void fail(std::string_view what) {
    throw RunError(fmt::format("{} ({}); without a display: dreampm play --headless --frames 60 --screenshot FOLDER",
                               what, last_error().empty() ? "no reason given" : last_error()));
  }

 private:
  // GLFW's callback has no user pointer.
  static std::string& last_error() {
    static std::string text;
    return text;
  }
};

class Window {
 public:
  Window(int width, int height, std::optional<float> ui_scale) : ui_scale_(ui_scale) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, "DreaMPM", nullptr, nullptr);
    if (!window_) Glfw::fail("no window with OpenGL 3.3 can be opened");
    glfwMakeContextCurrent(window_);
    gl::require_opengl_3_3();
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    // A click between two pictures, which a slow driver draws seldom, is not lost.
    glfwSetInputMode(window_, GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int code, int action, int mods) {
      Input& in = of(w).input_;
      const int known = key_of(key, glfwGetKeyName(key, code));
      // Of a key that came and went between two pictures.
      if (action != GLFW_RELEASE) in.control |= (mods & GLFW_MOD_CONTROL) != 0;
      if (known != 0)
        (action == GLFW_PRESS ? in.pressed : action == GLFW_REPEAT ? in.repeated : in.released).push_back(known);
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code) {
      if (code < 128) of(w).input_.text.push_back(static_cast<char>(code));
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
      of(w).input_.files.insert(of(w).input_.files.end(), paths, paths + count);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { of(w).input_.wheel += y; });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) { of(w).input_.inside = entered; });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { of(w).input_.inside = true; });
  }
  ~Window() { glfwDestroyWindow(window_); }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool closes() const { return glfwWindowShouldClose(window_); }
  void stay() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }
  void size(int& width, int& height) const { glfwGetFramebufferSize(window_, &width, &height); }
  float scale(int width, int height) const {
    if (ui_scale_) return *ui_scale_;
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::max({x, y, scale_of_size(width, height)});
  }
  void swap() { glfwSwapBuffers(window_); }
  /// What came in since the last call.
  Input take_input() {
    glfwPollEvents();
    int width = 0, height = 0, pixels_x = 0, pixels_y = 0;
    glfwGetWindowSize(window_, &width, &height);
    glfwGetFramebufferSize(window_, &pixels_x, &pixels_y);
    glfwGetCursorPos(window_, &input_.x, &input_.y);
    // Where screens count in larger units than pixels.
    if (width > 0 && height > 0)
      input_.x *= static_cast<double>(pixels_x) / width, input_.y *= static_cast<double>(pixels_y) / height;
    input_.time = glfwGetTime();
    const auto down = [&](int button) { return glfwGetMouseButton(window_, button) == GLFW_PRESS; };
    input_.left = down(GLFW_MOUSE_BUTTON_LEFT), input_.right = down(GLFW_MOUSE_BUTTON_RIGHT);
    input_.middle = down(GLFW_MOUSE_BUTTON_MIDDLE);
    // X11 counts a modifier's own press and release as before it: what the callback says is not
    // enough.
    const auto held = [&](int left, int right) {
      return glfwGetKey(window_, left) == GLFW_PRESS || glfwGetKey(window_, right) == GLFW_PRESS;
    };
    input_.control |= held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    input_.shift = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    Input taken = input_;
    input_.pressed.clear(), input_.repeated.clear(), input_.released.clear(), input_.text.clear();
    input_.files.clear(), input_.wheel = 0;
    input_.control = false;
    return taken;
  }

 private:
  static Window& of(GLFWwindow* w) { return *static_cast<Window*>(glfwGetWindowUserPointer(w)); }
  GLFWwindow* window_ = nullptr;
  std::optional<float> ui_scale_;
  Input input_;
};

/// Until the window is closed.
void show(Window& window, Worker& worker, App& app) {
  bool asked = false;
  while (!interrupted()) {
    worker.check();
    if (window.closes()) asked = true, window.stay();
    if (asked) {
      if (app.may_close(*worker.latest())) return;
      asked = app.asks_to_close();
    }
    int width = 0, height = 0;
    window.size(width, height);
    if (width < 1 || height < 1) {  // minimised
      glfwWaitEventsTimeout(0.1);
      continue;  // what came in is kept
    }
    const Input input = window.take_input();
    const std::shared_ptr<const Frame> frame = worker.latest();
    app.keep(frame);
    app.draw(*frame, input, width, height, window.scale(width, height));
    window.swap();
    if (app.wants_picture()) {
      const std::filesystem::path file = free_name("dreampm", ".png");
      try {
        write_png(file, app.view());
        info("wrote {}", file.string());
      } catch (const std::exception& e) {
        warn("no picture was saved: {}", e.what());
      }
    }
  }
}

}  // namespace

void play_in_window(Stage stage, const WindowOptions& options) {
  const Glfw glfw;
  Window window(options.width, options.height, options.ui_scale);
  std::ofstream record;
  Worker::Record write;
  if (!options.record.empty()) {
    record.open(options.record, std::ios::trunc);
    // Each tick reaches the file: what led to a crash is worth the most.
    write = [&](const std::string& lines) {
      if (!(record << lines << std::flush))
        throw RunError(fmt::format("{}: the record could not be written: {}", options.record.string(),
                                   std::generic_category().message(errno)));
    };
  }
  if (write) write(fmt::format("# dreampm {}\n{}\n", version, Action{"plays", {stage.name}}.text()));
  Worker worker(std::move(stage), options.play, write);
  App app([&](Action action) { return worker.post(std::move(action)); }, worker.threads(), worker.isa());
  show(window, worker, app);
  worker.stop();
  worker.check();
  if (interrupted()) throw Interrupted("interrupted");
}

}  // namespace dreampm::play
