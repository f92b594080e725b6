#include "dreampm/play/window/window.h"

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
#include <utility>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/play/model/worker.h"
#include "dreampm/play/window/app.h"
#include "dreampm/play/window/keys.h"
#include "dreampm/play/window/pace.h"
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
  Window(int width, int height, bool fits_screen, std::optional<float> ui_scale) : ui_scale_(ui_scale) {
    int wide = 0, high = 0;
    if (GLFWmonitor* const monitor = glfwGetPrimaryMonitor(); fits_screen && monitor)
      glfwGetMonitorWorkarea(monitor, nullptr, nullptr, &wide, &high);
    if (wide > 0 && high > 0) width = std::min(width, wide), height = std::min(height, high);
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
    // Buttons in the order in which they came, each where the pointer was: a slow driver draws
    // seldom, and clicks between two pictures are neither lost nor moved.
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
      Input& in = of(w).input_;
      if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
      in.control |= (mods & GLFW_MOD_CONTROL) != 0, in.shift = (mods & GLFW_MOD_SHIFT) != 0;
      (button == GLFW_MOUSE_BUTTON_LEFT    ? in.left
       : button == GLFW_MOUSE_BUTTON_RIGHT ? in.right
                                           : in.middle) = action == GLFW_PRESS;
      of(w).queue();
    });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { of(w).touched_ = true; });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { of(w).touched_ = true; });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int code, int action, int mods) {
      Input& in = of(w).input_;
      const int known = key_of(key, glfwGetKeyName(key, code));
      // Of a key that came and went between two pictures; keys with and without are no one moment.
      if (const bool control = (mods & GLFW_MOD_CONTROL) != 0; action != GLFW_RELEASE) {
        if (control != in.control && !in.pressed.empty()) of(w).queue();
        in.control |= control;
      }
      of(w).touched_ = true;
      if (known == 0) return;
      (action == GLFW_PRESS ? in.pressed : action == GLFW_REPEAT ? in.repeated : in.released).push_back(known);
      // What comes after it is no text of the field that it ends.
      if (action == GLFW_PRESS && (known == static_cast<int>(Key::enter) || known == static_cast<int>(Key::escape)))
        of(w).queue();
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code) {
      if (code < 128) of(w).input_.text.push_back(static_cast<char>(code));
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
      Window& own = of(w);
      own.input_.files.insert(own.input_.files.end(), paths, paths + count);
      double x = 0, y = 0;
      glfwGetCursorPos(w, &x, &y);
      own.pointer_at(x, y);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
      of(w).input_.wheel += y;
      of(w).touched_ = true;
    });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
      of(w).input_.inside = entered;
      of(w).touched_ = true;
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
      of(w).input_.inside = true;
      of(w).pointer_at(x, y);
    });
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
  /// What came in since the last call, each press or release of a button by itself, with Ctrl and
  /// Shift as they were then; at last how things are now.
  std::vector<Input> take_input() {
    glfwPollEvents();
    // X11 counts a modifier's own press and release as before it: what the callback says is not
    // enough.
    const auto held = [&](int left, int right) {
      return glfwGetKey(window_, left) == GLFW_PRESS || glfwGetKey(window_, right) == GLFW_PRESS;
    };
    input_.control |= held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    input_.shift = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    queue();
    return std::exchange(queued_, {});
  }
  /// Whether anything came in, or the picture is to be drawn anew, since the last call.
  bool was_touched() { return std::exchange(touched_, false); }
  /// Until something comes in, but no longer.
  void wait(double seconds) { glfwWaitEventsTimeout(seconds); }

 private:
  static Window& of(GLFWwindow* w) { return *static_cast<Window*>(glfwGetWindowUserPointer(w)); }
  /// Keeps what came in so far as a moment of its own.
  void queue() {
    input_.time = glfwGetTime();
    queued_.push_back(input_);
    input_.pressed.clear(), input_.repeated.clear(), input_.released.clear(), input_.text.clear();
    input_.files.clear(), input_.wheel = 0;
    input_.control = false;
    touched_ |= queued_.size() > 1 || input_.left || input_.right || input_.middle;
  }
  void pointer_at(double x, double y) {
    int width = 0, height = 0, pixels_x = 0, pixels_y = 0;
    glfwGetWindowSize(window_, &width, &height);
    glfwGetFramebufferSize(window_, &pixels_x, &pixels_y);
    // Where screens count in larger units than pixels.
    if (width > 0 && height > 0)
      x *= static_cast<double>(pixels_x) / width, y *= static_cast<double>(pixels_y) / height;
    input_.x = x, input_.y = y;
    touched_ = true;
  }

  GLFWwindow* window_ = nullptr;
  std::optional<float> ui_scale_;
  Input input_;
  std::vector<Input> queued_;
  bool touched_ = true;
};

/// A picture that somebody asked for.
void save_picture(App& app) {
  const std::filesystem::path file = free_name("dreampm", ".png");
  try {
    write_png(file, app.view());
    info("wrote {}", file.string());
    app.tell(fmt::format("saved {}", std::filesystem::absolute(file).string()));
  } catch (const std::exception& e) {
    warn("no picture was saved: {}", e.what());
    app.tell(fmt::format("no picture was saved: {}", e.what()), true);
  }
}

/// s, between two looks at a world that stands still.
constexpr double look_every = 0.1;

/// Until the window is closed.
void show(Window& window, Worker& worker, App& app) {
  bool asked = false, closes = false;
  PicturePace pace;
  while (!interrupted()) {
    worker.check();
    worker.hold(app.is_film_behind());
    if (window.closes()) asked = true, window.stay();
    if (asked) {
      closes = closes || app.may_close(*worker.latest());
      asked = app.asks_to_close();
    }
    if (closes && app.close_films(*worker.latest())) return;
    int width = 0, height = 0;
    window.size(width, height);
    if (width < 1 || height < 1) {  // minimised
      window.wait(look_every);
      continue;  // what came in is kept
    }
    const std::vector<Input> inputs = window.take_input();
    const bool touched = window.was_touched() || asked || closes;
    const std::shared_ptr<const Frame> frame = worker.latest();
    app.keep(frame);
    const float scale = window.scale(width, height);
    const bool draws = pace.is_due(*frame, inputs.back().time, touched, app.moves_until());
    // What the user does goes to the solver at once.
    if (draws || touched)
      for (const Input& input : inputs) app.update(*frame, input, width, height, scale);
    if (draws) {
      app.paint(*frame, inputs.back(), width, height);
      window.swap();
      pace.drew(*frame, inputs.back().time);
      if (app.wants_picture()) save_picture(app);
    } else {
      window.wait(frame->settings.paused ? look_every : 0.004);
    }
  }
}

}  // namespace

void play_in_window(PlayScene scene, const WindowOptions& options) {
  const Glfw glfw;
  Window window(options.width, options.height, options.fits_screen, options.ui_scale);
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
  if (write) write(fmt::format("# dreampm {}\n{}\n", version, Action{"plays", {scene.name}}.text()));
  Worker worker(std::move(scene), options.play, write);
  App app([&](Action action) { return worker.post(std::move(action)); }, worker.threads(), worker.backend());
  app.choose_size(options.particles.empty());
  if (!options.particles.empty() && options.particles != size_names()[1]) worker.post({"size", {options.particles}});
  show(window, worker, app);
  worker.stop();
  worker.check();
  if (interrupted()) throw Interrupted("interrupted");
}

}  // namespace dreampm::play
