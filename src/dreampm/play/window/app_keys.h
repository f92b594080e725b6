// What keys do in the window.
#pragma once
#include <functional>

#include "dreampm/play/model/frame.h"
#include "dreampm/play/panels/panels.h"
#include "dreampm/play/tools/cursor.h"
#include "dreampm/play/window/app.h"

namespace dreampm::play {

/// What keys act on.
struct KeyTarget {
  const Cursor::Post& post;
  Cursor& cursor;
  Panels& panels;
  bool& wants_picture;  ///< whether the picture to come is saved
  std::function<void(const Frame&)> save_last;

  void set(const std::string& id, double value) const { panels.host.set(id, value); }
  /// Turns over what was asked for last, however late frames are.
  void toggle(const Frame& frame, const std::string& id, double value) const {
    set(id, panels.host.asked(frame, id, value) == 0 ? 1 : 0);
  }
};

/// By the one list of keys, which key_help() shows in words.
void press_keys(const KeyTarget& target, const Frame& frame, const Input& input);
void release_keys(const KeyTarget& target, const Frame& frame, const Input& input);

}  // namespace dreampm::play
