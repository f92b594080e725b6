// "Render this": the dialog of a film with its estimate, and the film under way.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/base/progress.h"
#include "dreampm/play/model/rendering.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class RenderPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  void draw(const PanelView& view, PanelHost& host) override {
    if (std::exchange(host.asks_for_render, false)) open(view, host);
    progress(view, host);
    if (is_open_) dialog(view, host);
  }

 private:
  using State = RenderStatus::State;
  static constexpr float shortest = 0.5f, longest = 30;

  static std::string size_text(std::uint64_t bytes) {
    const auto b = static_cast<double>(bytes);
    return b < 1e9 ? fmt::format("{:.0f} MB", 1e-6 * b) : fmt::format("{:.1f} GB", 1e-9 * b);
  }

  /// Asks for the estimate of a film of what is seen now.
  void open(const PanelView& view, PanelHost& host) {
    is_open_ = true, was_paused_ = view.frame.settings.paused;
    scene_file_ = free_name(without_blanks(view.frame.story) + "-film", ".yaml").string();
    // What is seen now is what the film begins with.
    host.set("paused", 1);
    host.post("estimate", words(view.cursor));
  }

  std::vector<std::string> words(const Cursor& cursor) const {
    const gl::Camera& camera = cursor.camera();
    std::vector<std::string> words{scene_file_};
    const auto number = [&](float value) { words.push_back(text_of(static_cast<double>(value))); };
    number(seconds_);
    for (const Vec3f& v : {camera.eye, camera.target}) number(v.x), number(v.y), number(v.z);
    number(camera.view_angle * 180 / std::numbers::pi_v<float>);
    return words;
  }

  void dialog(const PanelView& view, PanelHost& host) {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    const auto close = [&](bool go_on) {
      is_open_ = false;
      if (go_on && !was_paused_) host.set("paused", 0);
    };
    place_in_the_middle();
    ImGui::Begin("Render this", nullptr, dialog_flags);
    ImGui::TextUnformatted("A film of what is seen, at 8 times the particles, made in the background.");
    ImGui::SetNextItemWidth(220 * scale);
    ImGui::SliderFloat("seconds", &seconds_, shortest, longest, "%.1f s");
    host.note_place("render seconds");
    seconds_ = std::clamp(seconds_, shortest, longest);
    if (ImGui::IsItemDeactivatedAfterEdit()) host.post("estimate", words(cursor));
    const RenderStatus* film = frame.rendering.get();
    const bool own = film && film->scene == scene_file_;
    if (own && film->state == State::estimated) {
      ImGui::Text("%s particles", grouped(film->particles).c_str());
      ImGui::Text("about %s on this machine", duration_text(film->seconds).c_str());
      ImGui::Text("%s of disk, %s of memory", size_text(film->disk_bytes).c_str(),
                  size_text(film->memory_bytes).c_str());
      if (!film->what.empty()) ImGui::TextColored(warning_orange(), "%s", film->what.c_str());
    } else if (own && film->state == State::failed) {
      ImGui::PushTextWrapPos(420 * scale);
      ImGui::TextColored(warning_orange(), "%s", film->what.c_str());
      ImGui::PopTextWrapPos();
      ImGui::Dummy({0, 0});
    } else if (film && !own && film->state == State::running) {
      ImGui::TextUnformatted("A film is under way: one at a time.");
    } else {
      ImGui::TextDisabled("estimating what it will take...");
      ImGui::TextUnformatted("");
      ImGui::TextUnformatted("");
    }
    if (ImGui::Button("Start", {100 * scale, 0})) host.post("render", words(cursor)), close(true);
    host.note_place("render start");
    ImGui::SameLine();
    if (ImGui::Button("Cancel", {100 * scale, 0})) {
      // The estimate that was asked for, whether or not the frame knows of it.
      if (!film || film->state != State::running) host.post("render", {"off"});
      dismissed_ = scene_file_;
      close(true);
    }
    host.note_place("render cancel");
    ImGui::End();
  }

  void progress(const PanelView& view, PanelHost& host) {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    const RenderStatus* film = frame.rendering.get();
    const bool in_dialog = is_open_ && film && film->scene == scene_file_;
    if (!film || film->state == State::estimated || in_dialog) return;
    const bool works = film->under_way();
    if (works) dismissed_.clear();
    if (!works && dismissed_ == film->scene) return;
    ImGui::SetNextWindowPos({layout.left + 10 * scale, height - layout.bottom - 48 * scale}, 0, {0, 1});
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
      if (ImGui::Button("Stop")) host.post("render", {"off"});
      host.note_place("render off");
    } else {
      if (film->state == State::done)
        ImGui::Text("Film: %s", film->film.c_str());
      else if (film->state == State::stopped)
        ImGui::Text("The film was stopped. dreampm make %s goes on with it.", film->scene.c_str());
      else
        ImGui::TextColored(warning_orange(), "No film: %s", film->what.c_str());
      if (film->state == State::done) {
        if (ImGui::Button("Open")) show_film(film->film);
        host.note_place("render open");
        ImGui::SameLine();
      }
      if (ImGui::Button("Close")) dismissed_ = film->scene;
      host.note_place("render close");
    }
    ImGui::PopTextWrapPos();
    ImGui::End();
  }

  bool is_open_ = false, was_paused_ = false;
  std::string scene_file_;
  float seconds_ = 3;      ///< of the film
  std::string dismissed_;  ///< the scene of a film whose end was seen
};

}  // namespace

std::unique_ptr<Panel> make_render_panel() { return std::make_unique<RenderPanel>(); }

}  // namespace dreampm::play
