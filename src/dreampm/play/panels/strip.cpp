// The strip below the picture: time, what is saved and filmed, and stories.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "dreampm/base/file.h"
#include "dreampm/error.h"
#include "dreampm/play/model/open_file.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panels.h"

namespace dreampm::play {

void Panels::open_file(const std::string& file) {
  try {
    post_(opening(file));
    new_stage_ = true;
  } catch (const InputError& e) {
    tell(e.what(), true);
  }
}

void Panels::file_menu() {
  const ImVec2 above = ImGui::GetItemRectMin();
  if (std::exchange(asks_for_file, false)) {
    files_ = files_to_open(".");
    path_.fill(0);
    ImGui::OpenPopup("files");
  }
  ImGui::SetNextWindowPos({above.x, above.y - 4 * scale}, ImGuiCond_Appearing, {0, 1});
  if (!ImGui::BeginPopup("files")) return;
  // The field that takes text would keep the key for itself.
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
    ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return;
  }
  ImGui::TextUnformatted("A scene, config, record or mesh:");
  ImGui::SetNextItemWidth(320 * scale);
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  if (ImGui::InputTextWithHint("##path", "path, then Enter", path_.data(), path_.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue) &&
      path_[0] != 0) {
    open_file(path_.data());
    ImGui::CloseCurrentPopup();
  }
  note_place("open path");
  if (!files_.empty()) {
    const float high = std::min(static_cast<float>(files_.size()), 10.0f) * ImGui::GetTextLineHeightWithSpacing();
    ImGui::BeginChild("here", {320 * scale, high + 4 * scale});
    for (const std::string& name : files_) {
      if (ImGui::Selectable(name.c_str())) open_file(name), ImGui::CloseCurrentPopup();
      note_place("open here " + name);
    }
    ImGui::EndChild();
  }
  ImGui::EndPopup();
}

void Panels::bottom_strip(const Frame& frame, Cursor& pointer, float width, float height) {
  const Layout l = layout(width, height);
  ImGui::SetNextWindowPos({l.left, height - l.bottom});
  ImGui::SetNextWindowSize({width - l.left, l.bottom});
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
  const bool paused = asked(frame, "paused", frame.settings.paused) != 0;
  if (ImGui::Button(paused ? "Play" : "Pause", {72 * scale, 0})) set("paused", paused ? 0 : 1);
  note_place(paused ? "set paused 0" : "set paused 1");
  next_button("Step");
  if (ImGui::Button("Step")) {
    if (!paused) set("paused", 1);
    post("step");
  }
  note_place("step");
  next_button("Restart");
  if (ImGui::Button("Restart")) post("restart");
  note_place("restart");
  next_button("Undo");
  const auto gray = [](bool off) {
    if (off) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.4f);
    return off;
  };
  const bool no_undo = gray(!frame.can_undo);
  if (ImGui::Button("Undo") && !no_undo) post("undo");
  note_place("undo");
  if (no_undo) ImGui::PopStyleVar();
  next_button("Redo");
  const bool no_redo = gray(!frame.can_redo);
  if (ImGui::Button("Redo") && !no_redo) post("redo");
  note_place("redo");
  if (no_redo) ImGui::PopStyleVar();
  next_button("Save");
  const std::filesystem::path file = std::filesystem::absolute(free_name(without_blanks(frame.story), ".yaml"));
  if (ImGui::Button("Save")) post("save", {file.string()});
  note_place("save");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene that dreampm make runs: %s", file.c_str());
  next_button("Open...");
  if (ImGui::Button("Open...")) asks_for_file = true;
  note_place("open");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene, config, record or mesh; Ctrl O");
  file_menu();
  next_button("Render...");
  if (ImGui::Button("Render...")) open_render(frame, pointer);
  note_place("render");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a film of this at 8 times the particles, made in the background");
  next(ImGui::GetFrameHeight());
  film_button(frame);
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
      if (!paused) set("paused", 1);
      post("seek", {text_of(-at)});
    }
    note_place("seek");
  } else {
    ImGui::TextDisabled("the past comes");
  }
  ImGui::BeginChild("stories", {0, 0}, false, ImGuiWindowFlags_HorizontalScrollbar);
  story_buttons(frame);
  ImGui::EndChild();
  if (new_stage_ && frame.story != story_) pointer.reset_camera(frame), new_stage_ = false;
  story_ = frame.story;
  ImGui::End();
}

}  // namespace dreampm::play
