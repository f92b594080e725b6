// What the panels of a window have in common: what they post, what they say, and what is asked of
// one by another.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/play/panels/control_list.h"
#include "dreampm/play/panels/panel.h"

namespace dreampm::play {

/// Where something to click stands, in the pixels of ImGui.
struct Place {
  /// The id of a control, the name of a color, "heading NAME", "seek", "tilt"; or what a click on a
  /// button posts.
  std::string what;
  float left = 0, top = 0, right = 0, bottom = 0;
};

/// One of the latest messages.
struct Note {
  std::string text;
  bool is_error;
  double until;              ///< s: when it goes
  std::uint64_t number = 0;  ///< of a message of the playground
};

/// As a line of text.
void draw_note(const Note& note);

class Pictures;

class PanelHost {
 public:
  explicit PanelHost(Cursor::Post post) : post_(std::move(post)) {}

  std::uint64_t post(Action action) { return post_(std::move(action)); }
  std::uint64_t post(std::string verb, std::vector<std::string> words = {}) {
    return post_(Action{std::move(verb), std::move(words)});
  }
  void set(const std::string& id, double value);
  /// What was asked for, where the frame does not know it yet; else `value`.
  double asked(const Frame& frame, const std::string& id, double value);
  /// A kind of matter; says why where the solver cannot do with it.
  void choose_matter(const Frame& frame, std::size_t kind);
  /// A scene, config, record or mesh in place of what is played; what cannot be opened is said.
  void open_file(const std::string& file);
  /// The first of FILE-001.mp4, FILE-002.mp4 .. that there is not, and that no film is written to.
  std::string free_film(const std::string& name) const;
  /// Begins a film of what is shown, or ends it.
  void toggle_film(const Frame& frame);
  /// Something for the messages.
  void tell(std::string what, bool is_error = false);
  /// Those that the frame has.
  void read_message(const Frame& frame);

  /// A heading in the left panel, open at first; whether it is open.
  bool heading(const std::string& name, bool opens = true);
  /// The item that was made last is of that name.
  void note_place(std::string what);
  /// A button of several of which one is chosen.
  bool choice(const std::string& text, bool is_chosen, float width = 0);

  float scale = 1;                     ///< of letters and panels, to ImGui's pixels
  const Pictures* pictures = nullptr;  ///< outlives this
  /// Whether arrows and Space go to the controls, one of which is framed then.
  bool by_keyboard = false;
  ControlList controls;
  std::vector<Place> places;  ///< of all that was drawn last
  std::vector<Note> notes;    ///< the latest ones, in their order
  bool edits = false;         ///< whether the control in use has changed matter or gravity
  float below_meters = 0;     ///< y of their lower edge
  /// Whether a film is being written to a file that is not there yet.
  std::function<bool(const std::string& file)> is_film = [](const std::string&) { return false; };
  // What another panel is to do.
  bool help = false;             ///< the page of keys
  bool asks_for_file = false;    ///< opens the list of files
  bool asks_for_render = false;  ///< opens the dialog of a film
  bool opens_scene = false;      ///< another was asked for: the camera goes to its place

 private:
  struct Asked {
    double value;
    std::uint64_t number;
  };
  Cursor::Post post_;
  std::map<std::string, Asked> asked_;
  std::uint64_t message_seen_ = 0;
};

}  // namespace dreampm::play
