// The strip below the picture: time, what is saved and filmed, and stories.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/play/model/open_file.h"
#include "dreampm/play/model/stories.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"
#include "dreampm/play/panels/picture_button.h"

namespace dreampm::play {
namespace {

class StripPanel final : public Panel {
 public:
  Where where() const override { return Where::beside; }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    ImGui::SetNextWindowPos({layout.left, height - layout.bottom});
    ImGui::SetNextWindowSize({width - layout.left, layout.bottom});
    ImGui::Begin("strip", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar);
    const float end = width - ImGui::GetStyle().WindowPadding.x;
    // Beside the last one where there is room for that much, else in a new row.
    const auto next = [&](float needed) {
      ImGui::SameLine();
      if (ImGui::GetCursorScreenPos().x + needed > end) ImGui::NewLine();
    };
    const auto next_button = [&](const char* text) {
      next(ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x);
    };
    const bool paused = host.asked(frame, "paused", frame.settings.paused) != 0;
    if (ImGui::Button(paused ? "Play" : "Pause", {72 * scale, 0})) host.set("paused", paused ? 0 : 1);
    host.note_place(paused ? "set paused 0" : "set paused 1");
    next_button("Step");
    if (ImGui::Button("Step")) {
      if (!paused) host.set("paused", 1);
      host.post("step");
    }
    host.note_place("step");
    next_button("Restart");
    if (ImGui::Button("Restart")) host.post("restart");
    host.note_place("restart");
    next_button("Undo");
    const auto gray = [](bool off) {
      if (off) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.4f);
      return off;
    };
    const bool no_undo = gray(!frame.can_undo);
    if (ImGui::Button("Undo") && !no_undo) host.post("undo");
    host.note_place("undo");
    if (no_undo) ImGui::PopStyleVar();
    next_button("Redo");
    const bool no_redo = gray(!frame.can_redo);
    if (ImGui::Button("Redo") && !no_redo) host.post("redo");
    host.note_place("redo");
    if (no_redo) ImGui::PopStyleVar();
    next_button("Save");
    const std::filesystem::path file = std::filesystem::absolute(free_name(without_blanks(frame.story), ".yaml"));
    if (ImGui::Button("Save")) host.post("save", {file.string()});
    host.note_place("save");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene that dreampm make runs: %s", file.c_str());
    next_button("Open...");
    if (ImGui::Button("Open...")) host.asks_for_file = true;
    host.note_place("open");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene, config, record or mesh; Ctrl O");
    file_menu(host);
    next_button("Render...");
    if (ImGui::Button("Render...")) host.asks_for_render = true;
    host.note_place("render");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("a film of this at 8 times the particles, made in the background");
    next(ImGui::GetFrameHeight());
    film_button(frame, host);
    next(200 * scale);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Rewind");
    ImGui::SameLine();
    // From the oldest moment that is kept to the latest.
    ImGui::SetNextItemWidth(std::max(80.0f, ImGui::GetContentRegionAvail().x));
    auto at = frame.future > 0 ? static_cast<float>(-frame.future) : 0.0f;
    const auto oldest = static_cast<float>(-(frame.past + frame.future));
    if (oldest < 0) {
      if (ImGui::SliderFloat("##rewind", &at, oldest, 0, "%.1f s")) {
        if (!paused) host.set("paused", 1);
        host.post("seek", {text_of(-at)});
      }
      host.note_place("seek");
    } else {
      ImGui::TextDisabled("the past comes");
    }
    ImGui::BeginChild("stories", {0, 0}, false, ImGuiWindowFlags_HorizontalScrollbar);
    story_buttons(frame, host);
    ImGui::EndChild();
    if (host.opens_scene && frame.story != story_) view.cursor.reset_camera(frame), host.opens_scene = false;
    story_ = frame.story;
    ImGui::End();
  }

 private:
  void file_menu(PanelHost& host) {
    const ImVec2 above = ImGui::GetItemRectMin();
    if (std::exchange(host.asks_for_file, false)) {
      files_ = files_to_open(".");
      path_.fill(0);
      ImGui::OpenPopup("files");
    }
    ImGui::SetNextWindowPos({above.x, above.y - 4 * host.scale}, ImGuiCond_Appearing, {0, 1});
    if (!ImGui::BeginPopup("files")) return;
    // The field that takes text would keep the key for itself.
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
      ImGui::CloseCurrentPopup();
      ImGui::EndPopup();
      return;
    }
    ImGui::TextUnformatted("A scene, config, record or mesh:");
    ImGui::SetNextItemWidth(320 * host.scale);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    if (ImGui::InputTextWithHint("##path", "path, then Enter", path_.data(), path_.size(),
                                 ImGuiInputTextFlags_EnterReturnsTrue) &&
        path_[0] != 0) {
      host.open_file(path_.data());
      ImGui::CloseCurrentPopup();
    }
    host.note_place("open path");
    if (!files_.empty()) {
      const float high = std::min(static_cast<float>(files_.size()), 10.0f) * ImGui::GetTextLineHeightWithSpacing();
      ImGui::BeginChild("here", {320 * host.scale, high + 4 * host.scale});
      for (const std::string& name : files_) {
        if (ImGui::Selectable(name.c_str())) host.open_file(name), ImGui::CloseCurrentPopup();
        host.note_place("open here " + name);
      }
      ImGui::EndChild();
    }
    ImGui::EndPopup();
  }

  /// A red dot that becomes a square.
  static void film_button(const Frame& frame, PanelHost& host) {
    const bool films = !frame.film.empty();
    const float side = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos(), middle{at.x + side / 2, at.y + side / 2};
    if (ImGui::Button("##film", {side, side})) host.toggle_film(frame);
    host.note_place(films ? "film off" : "film");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip(films ? "end the film; key V" : "film the picture as it is; key V");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float r = 0.24f * side;
    if (films)
      list.AddRectFilled({middle.x - r, middle.y - r}, {middle.x + r, middle.y + r}, color_of(film_red),
                         2 * host.scale);
    else
      list.AddCircleFilled(middle, r, color_of(film_red), 24);
  }

  /// Stories, and the report's presets.
  static void story_buttons(const Frame& frame, PanelHost& host) {
    constexpr std::size_t presets = 2;
    const std::size_t own = frame.preset_file == "report" ? 0 : frame.presets.size();
    const auto count = static_cast<float>(stories().size() + presets + own), gap = ImGui::GetStyle().ItemSpacing.x;
    const float width =
        std::clamp((ImGui::GetContentRegionAvail().x + gap) / count - gap, 66 * host.scale, 104 * host.scale);
    const ImVec2 size{width, ImGui::GetContentRegionAvail().y};
    const auto button = [&](const std::string& picture, const std::string& title, bool is_open,
                            const std::vector<std::string>& words) {
      if (picture_button(host.pictures, {picture, title, "", size, 0.64f, is_open}, host.scale))
        host.post("open", words), host.opens_scene = true;
      host.note_place(fmt::format("open {}", words.size() > 1 ? words[0] + " " + words[1] : words[0]));
      ImGui::SameLine();
    };
    for (const Story& s : stories())
      button(std::string(s.name), std::string(s.title), frame.story == s.name, {std::string(s.name)});
    // A config that was opened has its own.
    if (frame.preset_file != "report")
      for (std::size_t preset = 0; preset < frame.presets.size(); ++preset)
        button(fmt::format("preset-{}", preset + 1), frame.presets[preset], frame.preset == preset,
               {frame.preset_file, std::to_string(preset + 1)});
    for (std::size_t preset = 1; preset <= presets; ++preset)
      button(fmt::format("report-{}", preset), fmt::format("Report {}", preset),
             frame.preset_file == "report" && frame.preset + 1 == preset, {"report", std::to_string(preset)});
  }

  std::string story_;
  std::vector<std::string> files_;  ///< of the menu
  std::array<char, 512> path_{};    ///< typed there
};

}  // namespace

std::unique_ptr<Panel> make_strip_panel() { return std::make_unique<StripPanel>(); }

}  // namespace dreampm::play
