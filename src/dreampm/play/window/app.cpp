#include "dreampm/play/window/app.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/base/seconds_since.h"
#include "dreampm/gl/objects.h"
#include "dreampm/play/model/open_file.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/size_chooser.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/pictures.h"
#include "dreampm/play/panels/style.h"
#include "dreampm/play/tools/drop.h"
#include "dreampm/play/window/app.h"
#include "dreampm/play/window/app_keys.h"
#include "dreampm/play/window/picture_films.h"
#include "dreampm/play/window/view.h"

namespace dreampm::play {
namespace {

constexpr float font_size = 15;

/// Without scaling, into the framebuffer of that name.
void copy(const gl::Framebuffer& from, unsigned to, int x, int y) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.target().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, from.width(), from.height(), x, y, x + from.width(), y + from.height(), GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, to);
}

/// Dear ImGui takes its lists as a vector from 1.89 on, and as a pointer before.
template <class Lists>
void give_lists(ImVector<ImDrawList*>& lists, Lists& to) {
  if constexpr (std::is_pointer_v<Lists>)
    to = lists.Data;
  else
    to = lists;
}

/// What panels draw over the picture itself (its legend, its scale, the names of two sides) into
/// the framebuffer that is bound; `left`: where the picture begins in the window.
void draw_over(float left, float width, float height) {
  const ImDrawData& all = *ImGui::GetDrawData();
  ImVector<ImDrawList*> lists;
  for (int n = 0; n < all.CmdListsCount; ++n) {
    ImDrawList* const list = all.CmdLists[n];
    if (list == ImGui::GetBackgroundDrawList() || std::string_view(list->_OwnerName) == Panels::legend_window)
      lists.push_back(list);
  }
  ImDrawData some = all;
  give_lists(lists, some.CmdLists);
  some.CmdListsCount = lists.Size;
  some.TotalVtxCount = some.TotalIdxCount = 0;
  for (const ImDrawList* list : lists)
    some.TotalVtxCount += list->VtxBuffer.Size, some.TotalIdxCount += list->IdxBuffer.Size;
  some.DisplayPos = {left, 0}, some.DisplaySize = {width, height};
  ImGui_ImplOpenGL3_RenderDrawData(&some);
}

void fit(std::unique_ptr<gl::Framebuffer>& framebuffer, int width, int height) {
  if (!framebuffer) framebuffer = std::make_unique<gl::Framebuffer>(width, height);
  if (framebuffer->width() != width || framebuffer->height() != height) framebuffer->resize(width, height);
}

}  // namespace

struct App::Impl {
  Impl(const Cursor::Post& post, int threads, std::string backend, bool offscreen);
  ~Impl();

  /// What is seen beside the panels, of both sides while materials are compared, with the legend of
  /// its colors and its scale.
  RgbImage seen();
  /// What was drawn, into the film that the frame asks for, if it does.
  void film(const Frame& frame, double time);
  /// A film of the last seconds, as the camera stands now, goes on.
  void go_on_with_last();
  /// The sides of a frame into their framebuffers; with the ring of the brush, where there
  /// is one.
  void draw_sides(const Frame& frame, int width, int height, const std::optional<CursorMark>& mark);
  // Of a picture, in this order.
  void set_look(const Frame& frame, float to);
  void feed_imgui(const Input& input, int width, int height);
  void lay_out(const Frame& frame, int width, int height);
  void move_cursor(const Frame& frame, const Input& input);
  /// What tools do.
  std::uint64_t use_tool(const Action& action) {
    panels.note_use(action.verb);
    return post(action);
  }
  /// Scenes, configs and records are opened; meshes fall in, of the chosen matter, over the pointer
  /// at that place of the picture under it.
  void drop_files(const Frame& under, const std::vector<std::string>& files, double x, double y);
  KeyTarget keys() {
    return {post, cursor, panels, wants_picture,
            [this](const Frame& f) { films.save_last(panels.host.free_film(f.story + "-last")); }};
  }

  Cursor::Post post;
  Cursor cursor;
  Panels panels;
  View view;
  Pictures pictures;
  DrawingFacts facts;
  const bool offscreen;
  /// How wide the picture of a side is in one of `width` pixels.
  static int side_width(const Frame& frame, int width) { return frame.other ? std::max(1, width / 2) : width; }
  std::unique_ptr<gl::Framebuffer> scene, window;
  std::unique_ptr<gl::Framebuffer> second;  ///< the picture of side B; null while nothing is compared
  std::unique_ptr<gl::Framebuffer> whole;   ///< of pictures that are saved
  bool over_second = false;                 ///< whether the pointer is, or was when a drag began
  PictureFilms films{[this](const std::string& text, bool is_error) { panels.host.tell(text, is_error); }};
  double last_time = -1, painted = -1;  ///< s, of the last input and picture
  double shown_for = 0;                 ///< s, of the picture before the last
  bool has_font = false, has_camera = false, dark = false, was_left = false, was_right = false, was_middle = false,
       wants_picture = false;
  bool chooses_size = false;
  SizeChooser chooser;
  float scale = 0;
  std::vector<int> late_releases;
  int scene_width = 1, scene_height = 1;  ///< of the picture, or that of a side
  int picture_width = 1;                  ///< of all sides
  int left = 0, bottom = 0;               ///< pixels that the panels take from the picture
};

App::Impl::Impl(const Cursor::Post& post_, int threads, std::string backend, bool offscreen_)
    : post(post_), cursor([this](const Action& a) { return use_tool(a); }), panels(post_), offscreen(offscreen_) {
  panels.host.pictures = &pictures;
  panels.host.is_film = [this](const std::string& file) { return films.is_in_use(file); };
  facts.threads = threads, facts.backend = std::move(backend);
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  // What typing a number into a slider needs.
  const auto map = [&](ImGuiKey to, Key key) { io.KeyMap[to] = static_cast<int>(key); };
  map(ImGuiKey_Escape, Key::escape), map(ImGuiKey_Enter, Key::enter), map(ImGuiKey_Tab, Key::tab);
  map(ImGuiKey_Backspace, Key::backspace), map(ImGuiKey_Delete, Key::remove), map(ImGuiKey_LeftArrow, Key::left);
  map(ImGuiKey_RightArrow, Key::right), map(ImGuiKey_UpArrow, Key::up), map(ImGuiKey_DownArrow, Key::down);
  map(ImGuiKey_Home, Key::home), map(ImGuiKey_End, Key::end);
  io.KeyMap[ImGuiKey_A] = 'A', io.KeyMap[ImGuiKey_Space] = ' ';
  io.BackendPlatformName = "dreampm";
  const std::string font = font_file();
  has_font = !font.empty() && io.Fonts->AddFontFromFileTTF(font.c_str(), 2 * font_size);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}
App::Impl::~Impl() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

App::App(Cursor::Post post, int threads, std::string backend, bool offscreen)
    : impl_(std::make_unique<Impl>(post, threads, std::move(backend), offscreen)) {}
App::~App() = default;

void App::Impl::drop_files(const Frame& under, const std::vector<std::string>& files, double x, double y) {
  const double size = 2 * under.settings.radius;
  const Hit hit =
      pick(under, cursor.seen_by().ray(static_cast<float>(x), static_cast<float>(y), scene_width, scene_height));
  const Vec3d at = above(hit, under.domain, size, under.spacing);
  for (const std::string& file : files) {
    if (kind_of_file(file) == FileKind::mesh) {
      post(drop_file(file, at, size));
      continue;
    }
    panels.host.open_file(file);
  }
}

void App::Impl::set_look(const Frame& frame, float to) {
  if (to == scale && frame.settings.dark == dark) return;
  set_style(dark = frame.settings.dark);
  ImGui::GetStyle().ScaleAllSizes(scale = panels.host.scale = to);
  // Its letters are made at twice their size.
  ImGui::GetIO().FontGlobalScale = has_font ? 0.5f * to : to;
}

void App::Impl::feed_imgui(const Input& input, int width, int height) {
  ImGuiIO& io = ImGui::GetIO();
  const double seconds = last_time < 0 ? 1.0 / 60 : std::max(input.time - last_time, 1e-4);
  last_time = input.time;
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(seconds);
  io.MousePos = input.inside ? ImVec2{static_cast<float>(input.x), static_cast<float>(input.y)} : ImVec2{-1e9f, -1e9f};
  io.MouseDown[0] = input.left, io.MouseDown[1] = input.right, io.MouseDown[2] = input.middle;
  io.MouseWheel = static_cast<float>(input.wheel);
  io.KeyCtrl = input.control, io.KeyShift = input.shift;
  // A key that came and went since the last picture is up in the next one: ImGui would miss it.
  for (const int key : late_releases) io.KeysDown[key] = false;
  late_releases.clear();
  for (const int key : input.released) {
    if (key < 0 || key >= 512) continue;
    if (std::find(input.pressed.begin(), input.pressed.end(), key) != input.pressed.end())
      late_releases.push_back(key);
    else
      io.KeysDown[key] = false;
  }
  for (const int key : input.pressed)
    if (key >= 0 && key < 512) io.KeysDown[key] = true;
  for (const char c : input.text) io.AddInputCharacter(static_cast<unsigned char>(c));
  io.ConfigFlags = panels.host.by_keyboard ? ImGuiConfigFlags_NavEnableKeyboard : ImGuiConfigFlags_None;
  // Where pictures are slow, two clicks come late.
  io.MouseDoubleClickTime = 0.3f + static_cast<float>(std::min(shown_for, 0.5));
}

void App::Impl::lay_out(const Frame& frame, int width, int height) {
  const Layout l = panels.layout(static_cast<float>(width), static_cast<float>(height));
  left = static_cast<int>(l.left), bottom = static_cast<int>(l.bottom);
  if (!has_camera) cursor.reset_camera(frame), has_camera = true;
  picture_width = std::max(1, width - left);
  scene_width = side_width(frame, picture_width), scene_height = std::max(1, height - bottom);
  // A side is as wide as a picture of five to four, if need be by a wider view.
  cursor.resize(scene_width, scene_height, frame.other ? std::clamp(1.25 * scene_height / scene_width, 1.0, 2.0) : 1.0);
}

void App::Impl::move_cursor(const Frame& frame, const Input& input) {
  const bool over_panel = ImGui::GetIO().WantCaptureMouse;
  // A drag goes on in the picture in which it began.
  if (!(was_left || was_right || was_middle)) over_second = frame.other && input.x - left >= scene_width;
  const Frame& under = over_second ? frame.side_b() : frame.side_a();
  cursor.choose(static_cast<std::size_t>(panels.host.asked(frame, "tool", static_cast<double>(frame.settings.tool))));
  const double x = input.x - left - (over_second ? picture_width - scene_width : 0);
  if (input.inside && !over_panel)
    cursor.move(under, x, input.y, input.time);
  else
    cursor.leave();
  if (!input.files.empty()) drop_files(under, input.files, x, input.y);
  const auto button = [&](bool now, bool& before, Cursor::Button which) {
    if (now && !before && !over_panel) cursor.press(under, which, input.shift);
    if (!now && before) cursor.release(which);
    before = now;
  };
  button(input.left, was_left, Cursor::Button::left);
  button(input.right, was_right, Cursor::Button::right);
  button(input.middle, was_middle, Cursor::Button::middle);
  if (input.wheel != 0 && !over_panel) cursor.wheel(input.wheel);
  if (const std::string_view missed = cursor.missed_tool(); !missed.empty())
    panels.host.tell(fmt::format("{}: there is nothing under the pointer; a drag here turns the view", missed));
}

void App::update(const Frame& frame, const Input& input, int width, int height, float scale) {
  Impl& a = *impl_;
  a.set_look(frame, scale);
  a.feed_imgui(input, width, height);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  a.lay_out(frame, width, height);
  // Dear ImGui wants text for a picture more than there is a field that takes it.
  if (!ImGui::GetIO().WantTextInput || !ImGui::IsAnyItemActive()) press_keys(a.keys(), frame, input);
  release_keys(a.keys(), frame, input);
  a.move_cursor(frame, input);
  if (a.chooses_size && a.chooser.wants_small(frame, input.time)) {
    a.post({"size", {size_names().front()}});
    a.panels.host.tell("this machine did not keep up: fewer particles; key M has more");
  }
  a.panels.draw(frame, a.cursor, a.facts, static_cast<float>(width), static_cast<float>(height));
  ImGui::Render();
}

void App::draw(const Frame& frame, const Input& input, int width, int height, float scale) {
  update(frame, input, width, height, scale);
  paint(frame, input, width, height);
}

void App::paint(const Frame& frame, const Input& input, int width, int height) {
  Impl& a = *impl_;
  const double seconds = a.painted < 0 ? 1.0 / 60 : std::max(input.time - a.painted, 1e-4);
  a.painted = input.time;
  a.shown_for = seconds;
  if (!a.offscreen) a.facts.frames_a_second = 0.9 * a.facts.frames_a_second + 0.1 / seconds;
  const auto began = std::chrono::steady_clock::now();
  const int wide = std::max(1, width - a.left), high = std::max(1, height - a.bottom);
  const int side = Impl::side_width(frame, wide);
  if (a.offscreen) fit(a.window, width, height);
  const unsigned target = a.offscreen ? a.window->target().name() : 0;
  a.draw_sides(frame, side, high, a.cursor.mark());
  if (a.second) copy(*a.second, target, a.left + wide - side, a.bottom);
  copy(*a.scene, target, a.left, a.bottom);
  glViewport(0, 0, width, height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glFinish();
  a.facts.draw_ms = 1e3 * seconds_since(began);
  a.facts.look = a.view.look();
  // Off the screen nobody waits: pictures are the same on every machine.
  if (!a.offscreen) a.view.took(a.facts.draw_ms, seconds);
  a.film(frame, input.time);
  // A picture that is wanted is of what was drawn just now.
  if (!a.wants_picture) a.go_on_with_last();
}

void App::keep(std::shared_ptr<const Frame> frame) { impl_->films.keep(std::move(frame)); }

void App::Impl::draw_sides(const Frame& frame, int width, int height, const std::optional<CursorMark>& mark) {
  fit(scene, width, height);
  view.draw(frame.side_a(), cursor.seen_by(), mark, *scene);
  if (!frame.other) return second.reset();
  fit(second, width, height);
  view.draw(frame.side_b(), cursor.seen_by(), mark, *second);
}

void App::Impl::go_on_with_last() {
  films.go_on_with_last([&](const Frame& shown) {
    // Where the pointer is now it was not then.
    draw_sides(shown, scene->width(), scene->height(), std::nullopt);
    return seen();
  });
}

RgbImage App::Impl::seen() {
  const int wide = scene->width() + (second ? second->width() : 0), high = scene->height();
  fit(whole, wide, high);
  copy(*scene, whole->target().name(), 0, 0);
  if (second) copy(*second, whole->target().name(), scene->width(), 0);
  glViewport(0, 0, wide, high);
  draw_over(static_cast<float>(left), static_cast<float>(wide), static_cast<float>(high));
  return whole->read();
}

void App::Impl::film(const Frame& frame, double time) {
  // Nobody waits off the screen, where each picture belongs to the film.
  if (offscreen) films.wait_for_room();
  try {
    films.record(frame, time, [&] { return seen(); });
  } catch (const std::exception& e) {
    if (offscreen) throw;
    warn("no film: {}", e.what());
    panels.host.tell(fmt::format("no film: {}", e.what()), true);
    post({"film", {"off"}});
  }
  if (!offscreen) films.poll();
  facts.film_seconds = films.seconds(), facts.film_behind = films.seconds_behind();
  facts.film_waits = !offscreen && films.is_behind();
}

void App::choose_size(bool chooses) { impl_->chooses_size = chooses; }

void App::show_panels(bool shown) { impl_->panels.shown = shown; }

void App::finish_films() { impl_->films.finish(); }

bool App::close_films(const Frame& frame) {
  Impl& a = *impl_;
  if (!frame.film.empty()) a.post({"film", {"off"}});
  a.films.end();
  a.go_on_with_last();
  a.films.poll();
  if (a.films.are_written()) return true;
  // The same words each time: they take one place among the messages.
  a.panels.host.tell("the window closes when its films are written");
  return false;
}

bool App::is_film_behind() const { return !impl_->offscreen && impl_->films.is_behind(); }

RgbImage App::view() { return impl_->seen(); }

RgbImage App::picture() const { return impl_->window ? impl_->window->read() : impl_->scene->read(); }

const std::vector<Place>& App::places() const { return impl_->panels.host.places; }

bool App::may_close(const Frame& frame) { return impl_->panels.may_close(frame); }

bool App::asks_to_close() const { return impl_->panels.asks_to_close(); }

double App::moves_until() const {
  // What becomes of films is said where nothing else happens, too.
  constexpr double look_again = 1;
  return impl_->last_time + std::max(impl_->panels.moves_for(), impl_->films.are_written() ? 0 : look_again);
}

void App::tell(const std::string& what, bool is_error) { impl_->panels.host.tell(what, is_error); }

bool App::wants_picture() { return std::exchange(impl_->wants_picture, false); }

}  // namespace dreampm::play
