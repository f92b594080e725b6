// The controls of a heading: a slider, a switch, a list or a color for each.
#pragma once
#include <cstddef>
#include <set>
#include <string>

#include "dreampm/play/model/frame.h"

namespace dreampm::play {

class PanelHost;

class ControlList {
 public:
  /// Those of that panel, but for those that have buttons of their own.
  void draw(const Frame& frame, const std::string& panel, PanelHost& host);

 private:
  void control(const ControlInfo& info, double value, const LiveRange& live, PanelHost& host);
  void slider(const ControlInfo& info, double value, const LiveRange& live, PanelHost& host);
  /// The slider that was drawn last, `wide`, shows from where on it holds.
  void mark_live(const ControlInfo& info, const LiveRange& live, float wide);
  /// Of three controls, of which that is the first.
  void color(const Frame& frame, std::size_t first, PanelHost& host);

  /// A slider that is pressed.
  struct Held {
    std::string id;
    double value = 0;
    double began = 0;  ///< s
    float x = 0;       ///< of the press
    bool moved = false, has_value = false;
  } held_;
  std::set<std::string> all_of_;  ///< panels of materials that show all controls
  LiveRange live_of_drag_{};      ///< of the slider that is dragged, as its drag began
  enum class Holds { no, slow, soft };
  Holds holds_ = Holds::no;  ///< whether it would go further, and why it does not
};

}  // namespace dreampm::play
