// How large the world is, what moves it, and its gravity.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/play/model/play_scene.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class WorldPanel final : public Panel {
 public:
  Where where() const override { return Where::left; }
  void draw(const PanelView& view, PanelHost& host) override {
    if (!host.heading("World")) return;
    sizes(view.frame, host);
    solvers(view.frame, host);
    gravity_ball(view.frame, host);
    host.controls.draw(view.frame, "World", host);
  }

 private:
  static void sizes(const Frame& frame, PanelHost& host) {
    if (!frame.can_resize) return;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Particles");
    for (std::size_t n = 0; n < size_names().size(); ++n) {
      ImGui::SameLine();
      if (host.choice(fmt::format("{}##size", size_names()[n]), frame.size == n)) host.post("size", {size_names()[n]});
      host.note_place("size " + size_names()[n]);
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("begins anew; key M for the next");
    }
  }

  static void solvers(const Frame& frame, PanelHost& host) {
    static constexpr std::array<const char*, 2> meaning{
        "short steps, as sound asks for, of all matter",
        "large steps of liquids, whose volume a pressure keeps, and of what lies in them"};
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Solver");
    for (std::size_t n = 0; n < solver_names().size(); ++n) {
      ImGui::SameLine();
      const bool is_chosen = frame.solver == n, is_off = !is_chosen && !frame.no_other.empty();
      if (is_off) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.45f * ImGui::GetStyle().Alpha);
      if (host.choice(fmt::format("{}##solver", solver_names()[n]), is_chosen) && !is_chosen && !is_off)
        host.post("solver", {solver_names()[n]});
      host.note_place("solver " + solver_names()[n]);
      if (is_off) ImGui::PopStyleVar();
      if (!ImGui::IsItemHovered()) continue;
      if (is_off)
        ImGui::SetTooltip("%s", frame.no_other.c_str());
      else
        ImGui::SetTooltip("%s; begins anew; key %c", meaning[n], solver_key);
    }
  }

  static void shaded_ball(ImDrawList& list, ImVec2 middle, float radius, const Vec3f& color) {
    constexpr int rings = 6;
    for (int i = 0; i < rings; ++i) {
      const float t = static_cast<float>(i) / rings, light = 0.62f + 0.55f * t;
      const Vec3f c{std::min(color.x * light, 1.0f), std::min(color.y * light, 1.0f), std::min(color.z * light, 1.0f)};
      list.AddCircleFilled({middle.x - 0.28f * radius * t, middle.y - 0.30f * radius * t}, radius * (1 - 0.8f * t),
                           color_of(c), 32);
    }
  }

  /// The direction of gravity as a ball that rolls that way: a drag tilts the box.
  static void gravity_ball(const Frame& frame, PanelHost& host) {
    const float radius = 34 * host.scale;
    const ImVec2 at = ImGui::GetCursorScreenPos(), middle{at.x + radius + 4, at.y + radius};
    ImGui::InvisibleButton("gravity", {2 * radius + 8, 2 * radius});
    host.note_place("tilt");
    const double gx = host.asked(frame, "gravity.x", frame.settings.gravity_x),
                 gz = host.asked(frame, "gravity.z", frame.settings.gravity_z);
    constexpr double most = 9.8;
    if (ImGui::IsItemActive()) {
      const ImVec2 mouse = ImGui::GetIO().MousePos;
      double x = (mouse.x - middle.x) / radius * most, z = (mouse.y - middle.y) / radius * most;
      if (const double size = std::hypot(x, z); size > most) x *= most / size, z *= most / size;
      host.set("gravity.x", x), host.set("gravity.z", z);
      // It is turned and keeps its strength; where there is none it is the earth's.
      const double gy = host.asked(frame, "gravity.y", frame.settings.gravity_y), size = std::hypot(gx, gy, gz);
      const double strength = size > 0 ? size : 9.81, down = std::max(0.0, strength * strength - x * x - z * z);
      host.set("gravity.y", gy > 0 ? std::sqrt(down) : -std::sqrt(down));
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
      for (const ControlInfo& c : *frame.controls)
        if (c.id.starts_with("gravity.")) host.set(c.id, c.fallback);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("drag to tilt the box; double click: upright");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCircleFilled(middle, radius, ImGui::GetColorU32(ImGuiCol_FrameBg), 48);
    list.AddCircle(middle, radius, ImGui::GetColorU32(ImGuiCol_Border), 48);
    shaded_ball(list,
                {middle.x + static_cast<float>(gx / most) * radius * 0.8f,
                 middle.y + static_cast<float>(gz / most) * radius * 0.8f},
                9 * host.scale, {0.35f, 0.6f, 0.95f});
    ImGui::SameLine();
    ImGui::TextWrapped("tilt: drag the ball\nshake: arrow keys");
  }
};

}  // namespace

std::unique_ptr<Panel> make_world_panel() { return std::make_unique<WorldPanel>(); }

}  // namespace dreampm::play
