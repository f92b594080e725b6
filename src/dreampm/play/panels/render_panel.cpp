// Films. "Render this": its dialog with the estimate, the film under way, and what becomes of it
// when the window closes. And films of the picture as it is.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/base/file.h"
#include "dreampm/base/progress.h"
#include "dreampm/play/model/rendering.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panels.h"

namespace dreampm::play {
namespace {

using State = RenderStatus::State;
constexpr Vec3f film_red{0.86f, 0.16f, 0.16f};
constexpr float shortest = 0.5f, longest = 30;

constexpr ImGuiWindowFlags dialog_flags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove;

void in_the_middle() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, 0, {0.5f, 0.5f});
}

std::string size_text(std::uint64_t bytes) {
  const auto b = static_cast<double>(bytes);
  return b < 1e9 ? fmt::format("{:.0f} MB", 1e-6 * b) : fmt::format("{:.1f} GB", 1e-9 * b);
}

}  // namespace

void Panels::open_render(const Frame& frame, const Cursor& pointer) {
  render_dialog_.open = true, render_dialog_.was_paused = frame.settings.paused;
  render_dialog_.file = free_name(without_blanks(frame.story) + "-film", ".yaml").string();
  // What is seen now is what the film begins with.
  set("paused", 1);
  estimate(pointer);
}

void Panels::estimate(const Cursor& pointer) { post("estimate", render_words(pointer)); }

std::vector<std::string> Panels::render_words(const Cursor& pointer) const {
  const gl::Camera& camera = pointer.camera();
  std::vector<std::string> words{render_dialog_.file};
  const auto number = [&](float value) { words.push_back(text_of(static_cast<double>(value))); };
  number(render_dialog_.seconds);
  for (const Vec3f& v : {camera.eye, camera.target}) number(v.x), number(v.y), number(v.z);
  number(camera.view_angle * 180 / std::numbers::pi_v<float>);
  return words;
}

void Panels::render_dialog(const Frame& frame, const Cursor& pointer) {
  RenderDialog& dialog = render_dialog_;
  if (!dialog.open) return;
  const auto close = [&](bool go_on) {
    dialog.open = false;
    if (go_on && !dialog.was_paused) set("paused", 0);
  };
  in_the_middle();
  ImGui::Begin("Render this", nullptr, dialog_flags);
  ImGui::TextUnformatted("A film of what is seen, at 8 times the particles, made in the background.");
  ImGui::SetNextItemWidth(220 * scale);
  ImGui::SliderFloat("seconds", &dialog.seconds, shortest, longest, "%.1f s");
  note_place("render seconds");
  dialog.seconds = std::clamp(dialog.seconds, shortest, longest);
  if (ImGui::IsItemDeactivatedAfterEdit()) estimate(pointer);
  const RenderStatus* film = frame.rendering.get();
  const bool own = film && film->scene == dialog.file;
  if (own && film->state == State::estimated) {
    ImGui::Text("%s particles", grouped(film->particles).c_str());
    ImGui::Text("about %s on this machine", duration_text(film->seconds).c_str());
    ImGui::Text("%s of disk, %s of memory", size_text(film->disk_bytes).c_str(), size_text(film->memory_bytes).c_str());
    if (!film->what.empty()) ImGui::TextColored({0.95f, 0.55f, 0.2f, 1}, "%s", film->what.c_str());
  } else if (own && film->state == State::failed) {
    ImGui::PushTextWrapPos(420 * scale);
    ImGui::TextColored({0.95f, 0.55f, 0.2f, 1}, "%s", film->what.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Dummy({0, 0});
  } else if (film && !own && film->state == State::running) {
    ImGui::TextUnformatted("A film is under way: one at a time.");
  } else {
    ImGui::TextDisabled("estimating what it will take...");
    ImGui::TextUnformatted("");
    ImGui::TextUnformatted("");
  }
  if (ImGui::Button("Start", {100 * scale, 0})) post("render", render_words(pointer)), close(true);
  note_place("render start");
  ImGui::SameLine();
  if (ImGui::Button("Cancel", {100 * scale, 0})) {
    // The estimate that was asked for, whether or not the frame knows of it.
    if (!film || film->state != State::running) post("render", {"off"});
    put_away_ = dialog.file;
    close(true);
  }
  note_place("render cancel");
  ImGui::End();
}

void Panels::render_progress(const Frame& frame, float width, float height) {
  const RenderStatus* film = frame.rendering.get();
  const bool in_dialog = render_dialog_.open && film && film->scene == render_dialog_.file;
  if (!film || film->state == State::estimated || in_dialog) return;
  const bool works = film->under_way();
  if (works) put_away_.clear();
  if (!works && put_away_ == film->scene) return;
  const Layout l = layout(width, height);
  ImGui::SetNextWindowPos({l.left + 10 * scale, height - l.bottom - 48 * scale}, 0, {0, 1});
  ImGui::SetNextWindowBgAlpha(0.9f);
  ImGui::Begin("film", nullptr, dialog_flags | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoFocusOnAppearing);
  const float wide = 300 * scale;
  ImGui::PushTextWrapPos(wide);
  if (works) {
    if (film->stage.empty())
      ImGui::Text("Film: %s", film->state == State::estimating ? "estimating" : "beginning");
    else
      ImGui::Text("Film: %s, %d of %d", film->stage.c_str(), film->done, film->frames);
    const std::string left = film->state == State::running ? duration_text(film->left) + " left" : "";
    ImGui::ProgressBar(static_cast<float>(film->share), {wide, 0}, left.c_str());
    if (ImGui::Button("Stop")) post("render", {"off"});
    note_place("render off");
  } else {
    if (film->state == State::done)
      ImGui::Text("Film: %s", film->film.c_str());
    else if (film->state == State::stopped)
      ImGui::Text("The film was stopped. dreampm make %s goes on with it.", film->scene.c_str());
    else
      ImGui::TextColored({0.95f, 0.55f, 0.2f, 1}, "No film: %s", film->what.c_str());
    if (film->state == State::done) {
      if (ImGui::Button("Open")) show_film(film->film);
      note_place("render open");
      ImGui::SameLine();
    }
    if (ImGui::Button("Close")) put_away_ = film->scene;
    note_place("render close");
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
}

bool Panels::may_close(const Frame& frame) {
  if (closes_ || !frame.rendering || frame.rendering->state != State::running) return true;
  asks_to_close_ = true;
  return false;
}

void Panels::closing_dialog(const Frame& frame) {
  if (!asks_to_close_) return;
  in_the_middle();
  ImGui::Begin("A film is under way", nullptr, dialog_flags);
  const std::string scene = frame.rendering ? frame.rendering->scene : "";
  ImGui::Text("Stopped, dreampm make %s goes on with it.", scene.c_str());
  const auto button = [&](const char* name, const char* place) {
    const bool pressed = ImGui::Button(name);
    note_place(place);
    ImGui::SameLine();
    return pressed;
  };
  if (button("Stop it and close", "close stop")) closes_ = true;
  if (button("Close, and let it go on", "close leave")) post("render", {"leave"}), closes_ = true;
  if (button("Stay", "close stay")) asks_to_close_ = false;
  ImGui::End();
}

void Panels::toggle_film(const Frame& frame) {
  post("film", {frame.film.empty() ? free_name(without_blanks(frame.story), ".mp4").string() : "off"});
}

/// A red dot that becomes a square.
void Panels::film_button(const Frame& frame) {
  const bool films = !frame.film.empty();
  const float side = ImGui::GetFrameHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos(), middle{at.x + side / 2, at.y + side / 2};
  if (ImGui::Button("##film", {side, side})) toggle_film(frame);
  note_place(films ? "film off" : "film");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(films ? "end the film; key V" : "film the picture as it is; key V");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = 0.24f * side;
  if (films)
    list.AddRectFilled({middle.x - r, middle.y - r}, {middle.x + r, middle.y + r}, color_of(film_red), 2 * scale);
  else
    list.AddCircleFilled(middle, r, color_of(film_red), 24);
}

void Panels::film_mark(const DrawingFacts& facts, float width, float height, float top) {
  if (!facts.film_seconds) return;
  const Layout l = layout(width, height);
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const float line = ImGui::GetFontSize();
  const ImVec2 at{l.left + 14 * scale, top};
  const std::string text =
      fmt::format("{}:{:04.1f}", static_cast<int>(*facts.film_seconds) / 60, std::fmod(*facts.film_seconds, 60));
  list.AddRectFilled({at.x - 6 * scale, at.y - 4 * scale},
                     {at.x + 1.4f * line + ImGui::CalcTextSize(text.c_str()).x + 6 * scale, at.y + line + 4 * scale},
                     ImGui::GetColorU32(ImGuiCol_PopupBg, 0.8f), 5 * scale);
  list.AddCircleFilled({at.x + line / 2, at.y + line / 2}, 0.4f * line, color_of(film_red), 24);
  list.AddText({at.x + 1.4f * line, at.y}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

}  // namespace dreampm::play
