#include "dreampm/play/app.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <utility>

#include "dreampm/base/seconds_since.h"
#include "dreampm/gl/objects.h"
#include "dreampm/play/view.h"

namespace dreampm::play {
namespace {

constexpr float font_size = 15;
/// m/s^2, of an arrow key.
constexpr double shake_strength = 12;

/// A font that is easier to read than ImGui's own, where the machine has it.
constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

void set_style(bool dark) {
  ImGui::GetStyle() = ImGuiStyle();
  if (dark)
    ImGui::StyleColorsDark();
  else
    ImGui::StyleColorsLight();
  ImGuiStyle& s = ImGui::GetStyle();
  s.WindowRounding = 0, s.FrameRounding = 5, s.GrabRounding = 5, s.PopupRounding = 5, s.ScrollbarRounding = 6;
  s.FramePadding = {7, 4}, s.ItemSpacing = {6, 6}, s.WindowPadding = {12, 10};
  s.WindowBorderSize = 0;
  if (!dark) s.Colors[ImGuiCol_WindowBg] = {0.955f, 0.962f, 0.97f, 1};
}

/// Without scaling, into the framebuffer of that name.
void copy(const gl::Framebuffer& from, unsigned to, int x, int y) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.target().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, from.width(), from.height(), x, y, x + from.width(), y + from.height(), GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, to);
}

void fit(std::unique_ptr<gl::Framebuffer>& framebuffer, int width, int height) {
  if (!framebuffer) framebuffer = std::make_unique<gl::Framebuffer>(width, height);
  if (framebuffer->width() != width || framebuffer->height() != height) framebuffer->resize(width, height);
}

}  // namespace

struct App::Impl {
  Impl(const Pointer::Post& post_, int threads, std::string isa, bool offscreen_)
      : post(post_), pointer(post_), panels(post_), offscreen(offscreen_) {
    facts.threads = threads, facts.isa = std::move(isa);
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    // What typing a number into a slider needs.
    const auto map = [&](ImGuiKey to, Key key) { io.KeyMap[to] = static_cast<int>(key); };
    map(ImGuiKey_Escape, Key::escape), map(ImGuiKey_Enter, Key::enter), map(ImGuiKey_Tab, Key::tab);
    map(ImGuiKey_Backspace, Key::backspace), map(ImGuiKey_Delete, Key::remove), map(ImGuiKey_LeftArrow, Key::left);
    map(ImGuiKey_RightArrow, Key::right), map(ImGuiKey_Home, Key::home), map(ImGuiKey_End, Key::end);
    io.KeyMap[ImGuiKey_A] = 'A', io.KeyMap[ImGuiKey_Space] = ' ';
    io.BackendPlatformName = "dreampm";
    if (std::filesystem::exists(font_file)) io.Fonts->AddFontFromFileTTF(font_file, 2 * font_size);
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~Impl() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
  }

  void keys(const Frame& frame, const Input& input);
  std::uint64_t set(const std::string& id, double value) { return post({"set", {id, text_of(value)}}); }

  Pointer::Post post;
  Pointer pointer;
  Panels panels;
  View view;
  DrawingFacts facts;
  const bool offscreen;
  std::unique_ptr<gl::Framebuffer> scene, window;
  double last_time = -1;
  bool has_camera = false, dark = false, was_left = false, was_right = false, was_middle = false, wants_picture = false;
  float scale = 0;
  std::vector<int> late_releases;
  int left = 0, bottom = 0;  ///< pixels that the panels take from the picture
};

void App::Impl::keys(const Frame& frame, const Input& input) {
  const Settings& s = frame.settings;
  for (const int key : input.pressed) {
    if (const std::string_view digits = "1234567890"; key < 128 && digits.find(static_cast<char>(key)) != digits.npos)
      set("matter", static_cast<double>(digits.find(static_cast<char>(key))));
    static constexpr std::string_view tools = "QGODCEN";
    if (!input.control && key < 128 && tools.find(static_cast<char>(key)) != tools.npos)
      set("tool", static_cast<double>(tools.find(static_cast<char>(key))));
    switch (key) {
      case ' ':
        set("paused", s.paused == 0 ? 1 : 0);
        break;
      case '.':
        if (s.paused == 0) set("paused", 1);
        post({"step", {}});
        break;
      case 'R':
        post({"restart", {}});
        break;
      case 'Z':
        if (input.control) post({"undo", {}});
        break;
      case 'Y':
        if (input.control) post({"redo", {}});
        break;
      case 'F':
        pointer.reset_camera(frame);
        break;
      case 'B':
        set("dark", s.dark == 0 ? 1 : 0);
        break;
      case 'P':
        pointer.hold_pour(frame, true);
        break;
      case '[':
        set("radius", std::max(s.radius / 1.25, 0.02));
        break;
      case ']':
        set("radius", std::min(s.radius * 1.25, 0.3));
        break;
      case static_cast<int>(Key::left):
        post({"shake", {text_of(-shake_strength), "0", "0"}});
        break;
      case static_cast<int>(Key::right):
        post({"shake", {text_of(shake_strength), "0", "0"}});
        break;
      case static_cast<int>(Key::up):
        post({"shake", {"0", "0", text_of(-shake_strength)}});
        break;
      case static_cast<int>(Key::down):
        post({"shake", {"0", "0", text_of(shake_strength)}});
        break;
      case static_cast<int>(Key::tab):
        panels.shown = !panels.shown;
        break;
      case static_cast<int>(Key::f1):
        panels.help = !panels.help;
        break;
      case static_cast<int>(Key::escape):
        panels.help = false;
        break;
      case static_cast<int>(Key::f12):
        wants_picture = true;
        break;
      default:
        break;
    }
  }
}

App::App(Pointer::Post post, int threads, std::string isa, bool offscreen)
    : impl_(std::make_unique<Impl>(post, threads, std::move(isa), offscreen)) {}
App::~App() = default;

void App::take(const Frame& frame, const Input& input, int width, int height, float scale) {
  Impl& a = *impl_;
  ImGuiIO& io = ImGui::GetIO();
  const bool dark = frame.settings.dark != 0;
  if (scale != a.scale || dark != a.dark) {
    set_style(a.dark = dark);
    ImGui::GetStyle().ScaleAllSizes(a.scale = a.panels.scale = scale);
    // The letters are made at twice their size.
    io.FontGlobalScale = io.Fonts->Fonts.empty() || !std::filesystem::exists(font_file) ? scale : 0.5f * scale;
  }
  const double seconds = a.last_time < 0 ? 1.0 / 60 : std::max(input.time - a.last_time, 1e-4);
  a.last_time = input.time;
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(seconds);
  io.MousePos = input.inside ? ImVec2{static_cast<float>(input.x), static_cast<float>(input.y)} : ImVec2{-1e9f, -1e9f};
  io.MouseDown[0] = input.left, io.MouseDown[1] = input.right, io.MouseDown[2] = input.middle;
  io.MouseWheel = static_cast<float>(input.wheel);
  io.KeyCtrl = input.control, io.KeyShift = input.shift;
  // A key that came and went since the last picture is up in the next one: ImGui would miss it.
  for (const int key : a.late_releases) io.KeysDown[key] = false;
  a.late_releases.clear();
  for (const int key : input.released) {
    if (key < 0 || key >= 512) continue;
    if (std::find(input.pressed.begin(), input.pressed.end(), key) != input.pressed.end())
      a.late_releases.push_back(key);
    else
      io.KeysDown[key] = false;
  }
  for (const int key : input.pressed)
    if (key >= 0 && key < 512) io.KeysDown[key] = true;
  for (const char c : input.text) io.AddInputCharacter(static_cast<unsigned char>(c));
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();

  const Layout l = a.panels.layout(static_cast<float>(width), static_cast<float>(height));
  const int left = a.left = static_cast<int>(l.left), bottom = a.bottom = static_cast<int>(l.bottom);
  if (!a.has_camera) a.pointer.reset_camera(frame), a.has_camera = true;
  a.pointer.resize(std::max(1, width - left), std::max(1, height - bottom));
  if (!io.WantTextInput) a.keys(frame, input);
  for (const int key : input.released)
    if (key == 'P') a.pointer.hold_pour(frame, false);
  const bool over_panel = io.WantCaptureMouse;
  if (input.inside && !over_panel)
    a.pointer.move(frame, input.x - left, input.y, input.time);
  else
    a.pointer.leave();
  const auto button = [&](bool now, bool& before, Pointer::Button which) {
    if (now && !before && !over_panel) a.pointer.press(frame, which);
    if (!now && before) a.pointer.release(which);
    before = now;
  };
  button(input.left, a.was_left, Pointer::Button::left);
  button(input.right, a.was_right, Pointer::Button::right);
  button(input.middle, a.was_middle, Pointer::Button::middle);
  if (input.wheel != 0 && !over_panel) a.pointer.wheel(input.wheel);
  a.facts.frames_a_second = 0.9 * a.facts.frames_a_second + 0.1 / seconds;
  a.panels.draw(frame, a.pointer, a.facts, static_cast<float>(width), static_cast<float>(height));
  ImGui::Render();
}

void App::draw(const Frame& frame, const Input& input, int width, int height, float scale) {
  take(frame, input, width, height, scale);
  Impl& a = *impl_;
  const auto began = std::chrono::steady_clock::now();
  fit(a.scene, std::max(1, width - a.left), std::max(1, height - a.bottom));
  if (a.offscreen) fit(a.window, width, height);
  a.view.draw(frame, a.pointer.camera, a.pointer.mark(), *a.scene);
  copy(*a.scene, a.offscreen ? a.window->target().name() : 0, a.left, a.bottom);
  glViewport(0, 0, width, height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glFinish();
  a.facts.draw_ms = 1e3 * seconds_since(began);
  a.facts.look = a.view.look();
  a.view.took(a.facts.draw_ms);
}

RgbImage App::view() const { return impl_->scene->read(); }

RgbImage App::picture() const { return impl_->window ? impl_->window->read() : impl_->scene->read(); }

const std::vector<Place>& App::places() const { return impl_->panels.places(); }

bool App::wants_picture() { return std::exchange(impl_->wants_picture, false); }

}  // namespace dreampm::play
