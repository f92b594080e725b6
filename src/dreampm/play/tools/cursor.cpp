#include "dreampm/play/tools/cursor.h"

#include <algorithm>
#include <cmath>

namespace dreampm::play {
namespace {

constexpr double no_move = 1e-9;
/// Pixels that a click may move by.
constexpr double still_a_click = 3;

}  // namespace

Tool& Cursor::tool(const Frame& frame) const {
  return *tools_.find(tool_buttons().at(chosen_.value_or(frame.settings.tool)).name);
}

void Cursor::end_hover() {
  if (hovers_) std::exchange(hovers_, nullptr)->leave(gesture_);
}

void Cursor::move(const Frame& frame, double x, double y, double time) {
  Gesture& g = gesture_;
  g.seconds = std::max(time - time_, 1e-3), time_ = time;
  g.dx = x - g.x, g.dy = y - g.y, g.x = x, g.y = y;
  g.settings = frame.settings, g.spacing = frame.spacing, g.domain = frame.domain, g.room = frame.room;
  const bool moved = std::abs(g.dx) + std::abs(g.dy) >= no_move;
  if (drags_) {
    if (g.is_drag) {
      if (drags_->picks_while_dragged()) g.hit = drags_->pick(frame, g.ray());
      mark_ = drags_->mark(g);
    }
    if (moved) drags_->drag(g);
    return;
  }
  Tool& own = tool(frame);
  g.hit = own.pick(frame, g.ray());
  mark_ = own.mark(g);
  if (held_) {
    if (moved) held_->drag(g);
    return;
  }
  if (hovers_ != &own) end_hover();
  (hovers_ = &own)->hover(g);
}

void Cursor::leave() {
  end_hover();
  gesture_.hit.reset(), mark_.reset();
}

void Cursor::press(const Frame& frame, Button button, bool shift) {
  if (down_) return;
  down_ = button;
  Gesture& g = gesture_;
  g.is_pressed = true, g.from_x = g.x, g.from_y = g.y;
  end_hover();
  if (button != Button::left) {
    drags_ = tools_.find(shift && button == Button::right ? "turn" : "shift");
    return;
  }
  if (!g.hit) return;
  Tool& own = tool(frame);
  if (own.info().needs_matter && !g.hit->matter) {
    drags_ = tools_.find("turn"), beside_ = own.info().name;
    return;
  }
  drags_ = &own;
  g.is_drag = true, g.from = g.hit->at;
  own.press(g);
}

void Cursor::release(Button button) {
  if (down_ != button) return;
  down_.reset();
  Gesture& g = gesture_;
  if (g.is_drag) drags_->release(g);
  // A click that meant the tool, and no drag.
  if (!beside_.empty() && std::hypot(g.x - g.from_x, g.y - g.from_y) < still_a_click) missed_ = beside_;
  g.is_drag = g.is_pressed = false, drags_ = nullptr, beside_ = {};
}

void Cursor::wheel(double clicks) { gesture_.camera.zoom(static_cast<float>(std::pow(0.9, clicks))); }

void Cursor::hold(std::string_view tool, bool held) {
  Tool* const own = tools_.find(tool);
  if (held == (held_ == own)) return;
  end_hover();
  if (held && !gesture_.hit) missed_ = own->info().name;
  held_ = held ? own : nullptr;
  if (held)
    own->press(gesture_);
  else
    own->release(gesture_);
}

}  // namespace dreampm::play
