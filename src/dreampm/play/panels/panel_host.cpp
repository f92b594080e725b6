#include "dreampm/play/panels/panel_host.h"

#include <fmt/format.h>
#include <imgui.h>

#include <filesystem>

#include "dreampm/error.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/open_file.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/panels/imgui_text.h"

namespace dreampm::play {
namespace {

/// s: how long a message stands, and how many are kept to be read again.
constexpr double message_stands = 8;
constexpr std::size_t kept_messages = 5;

}  // namespace

void draw_note(const Note& note) {
  if (note.is_error)
    ImGui::TextColored({0.85f, 0.36f, 0.08f, 1}, "%s", note.text.c_str());
  else
    ImGui::TextUnformatted(note.text.c_str());
}

void PanelHost::set(const std::string& id, double value) {
  asked_[id] = {value, post("set", {id, text_of(value)})};
  edits = edits || id.starts_with("material.") || id.starts_with("gravity.");
}

double PanelHost::asked(const Frame& frame, const std::string& id, double value) {
  const auto it = asked_.find(id);
  if (it == asked_.end()) return value;
  if (frame.actions < it->second.number) return it->second.value;
  asked_.erase(it);
  return value;
}

void PanelHost::choose_matter(const Frame& frame, std::size_t kind) {
  const bool is_refused = kind < frame.matter_refusals.size() && !frame.matter_refusals[kind].empty();
  if (!is_refused) return set("matter", static_cast<double>(kind));
  tell(fmt::format("{}: {}{}", matters()[kind].title, frame.matter_refusals[kind],
                   frame.no_other.empty() ? fmt::format("; the other solver can (key {})", solver_key) : ""),
       true);
}

void PanelHost::open_file(const std::string& file) {
  try {
    post(opening(file));
    opens_scene = true;
  } catch (const InputError& e) {
    tell(e.what(), true);
  }
}

std::string PanelHost::free_film(const std::string& name) const {
  for (int n = 1;; ++n)
    if (std::string file = fmt::format("{}-{:03}.mp4", without_blanks(name), n);
        !std::filesystem::exists(file) && !is_film(file))
      return file;
}

void PanelHost::toggle_film(const Frame& frame) { post("film", {frame.film.empty() ? free_film(frame.story) : "off"}); }

void PanelHost::tell(std::string what, bool is_error) {
  if (!notes.empty() && notes.back().text == what) notes.pop_back();
  notes.push_back({std::move(what), is_error, ImGui::GetTime() + message_stands});
  if (notes.size() > kept_messages) notes.erase(notes.begin());
}

void PanelHost::read_message(const Frame& frame) {
  if (frame.message.empty()) return;
  if (frame.message_number == std::exchange(message_seen_, frame.message_number)) {
    // What it counts may have become more.
    for (Note& note : notes)
      if (note.number == frame.message_number && note.text != frame.message)
        note.text = frame.message, note.until = ImGui::GetTime() + message_stands;
    return;
  }
  tell(frame.message, frame.message_is_error);
  notes.back().number = frame.message_number;
}

bool PanelHost::heading(const std::string& name, bool opens) {
  const bool is_open = ImGui::CollapsingHeader(name.c_str(), opens ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  note_place("heading " + name);
  return is_open;
}

void PanelHost::note_place(std::string what) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  places.push_back({std::move(what), from.x, from.y, to.x, to.y});
}

bool PanelHost::choice(const std::string& text, bool is_chosen, float width) {
  if (is_chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  const bool is_pressed = ImGui::Button(text.c_str(), {width, 0});
  if (is_chosen) ImGui::PopStyleColor();
  return is_pressed;
}

}  // namespace dreampm::play
