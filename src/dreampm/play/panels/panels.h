// The panels of the window, by Dear ImGui: what they show comes from a frame, what they change goes
// out as actions.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/play/model/frame.h"
#include "dreampm/play/tools/cursor.h"

namespace dreampm::play {

/// What the window knows beside the frame.
struct DrawingFacts {
  double draw_ms = 0;
  double frames_a_second = 0;  ///< 0: nobody watches
  int threads = 0;
  std::string isa;
  std::string_view look;
  std::optional<double> film_seconds;  ///< of the film that is being made of what is drawn
};

/// How large letters and panels are in a window of that size where nobody says it: twice as large
/// in 3840 x 2160 pixels, by quarters.
float scale_of_size(int width, int height);

/// In the pixels of ImGui.
struct Layout {
  float left = 0;    ///< the panel's width
  float bottom = 0;  ///< the strip's height
};

/// Where something to click stands, in the pixels of ImGui.
struct Place {
  /// The id of a control, the name of a color, "heading NAME", "seek", "tilt"; or what a click on a
  /// button posts.
  std::string what;
  float left = 0, top = 0, right = 0, bottom = 0;
};

class Pictures;

class Panels {
 public:
  explicit Panels(Cursor::Post post) : post_(std::move(post)) {}

  /// Between ImGui::NewFrame and ImGui::Render. `size`: of the window.
  void draw(const Frame& frame, Cursor& pointer, const DrawingFacts& facts, float width, float height);
  /// Where the picture is, in a window of that size.
  Layout layout(float width, float height) const;
  /// Of all that was drawn last; what is scrolled out of its panel lies outside of the window.
  const std::vector<Place>& places() const { return places_; }
  /// The hand has done something: a hint that says how is not needed any more.
  void note_use(std::string_view verb);
  /// Begins a film of what is shown, or ends it.
  void toggle_film(const Frame& frame);
  /// Whether the window may close now. Where a film is under way a dialog asks first.
  bool may_close(const Frame& frame);
  /// Whether that dialog stands open.
  bool asks_to_close() const { return asks_to_close_; }
  /// Something for the messages.
  void tell(std::string what, bool is_error = false);
  /// Closes lists and menus that stand open; whether there was one.
  bool close_menus();
  /// s, from now: for how long something here changes by itself.
  double moves_for() const;
  const Pictures* pictures = nullptr;  ///< outlives this
  /// Of the window with the legend: it belongs to the picture.
  static constexpr const char* legend_window = "legend";

  /// A scene, config, record or mesh in place of what is played; what cannot be opened is said.
  void open_file(const std::string& file);

  bool shown = true, help = false;
  bool asks_for_file = false;  ///< opens the list of files
  /// Whether arrows and Space go to the controls, one of which is framed then.
  bool by_keyboard = false;
  float scale = 1;  ///< of letters and panels, to ImGui's pixels

  void set(const std::string& id, double value);
  /// A kind of matter; says why where the solver cannot do with it.
  void choose_matter(const Frame& frame, std::size_t kind);
  /// What was asked for, where the frame does not know it yet; else `value`.
  double asked(const Frame& frame, const std::string& id, double value);

 private:
  // control_panel.cpp: controls_of to color.
  // strip.cpp: bottom_strip.
  void left_panel(const Frame& frame, float width, float height);
  void tool_buttons(const Frame& frame);
  /// Those that tools have beside their own.
  void buttons_of_tools(const Frame& frame);
  void gravity_ball(const Frame& frame);
  void compare_buttons(const Frame& frame);
  /// Whether the picture, or that of a side, is too small for all lines of the meters.
  bool is_narrow(const Frame& frame, float width, float height) const;
  void compare_labels(const Frame& frame, float width, float height);
  void controls_of(const Frame& frame, const std::string& panel);
  void control(const ControlInfo& info, double value, const LiveRange& live);
  void slider(const ControlInfo& info, double value, const LiveRange& live);
  /// The slider that was drawn last, `wide`, shows from where on it holds.
  void mark_live(const ControlInfo& info, const LiveRange& live, float wide);
  /// Of three controls, of which that is the first.
  void color(const Frame& frame, std::size_t first);
  void bottom_strip(const Frame& frame, Cursor& pointer, float width, float height);
  void meters(const Frame& frame, const DrawingFacts& facts, float width, float height);
  void meter_details(const Frame& frame, const DrawingFacts& facts, float wide);
  /// Keeps what the frame says.
  void take_message(const Frame& frame);
  /// The last message, for some seconds.
  void message(const Frame& frame, float width, float height);
  void legend(const Frame& frame, float width, float height);
  void scale_bar(const Frame& frame, const Cursor& pointer, float width, float height);
  void file_menu();
  void size_buttons(const Frame& frame);
  void solver_buttons(const Frame& frame);
  /// `top`: below what else is at the upper left.
  void hints(float width, float height, float top);
  double fades_at(std::string_view hint) const;  ///< s
  void help_page();
  // picture_buttons.cpp
  void matter_buttons(const Frame& frame);
  /// Of the report's material.
  void look_buttons(const Frame& frame);
  /// Stories, and the report's presets.
  void story_buttons(const Frame& frame);
  // render_panel.cpp
  /// Asks for the estimate of a film of what is seen now.
  void open_render(const Frame& frame, const Cursor& pointer);
  void estimate(const Cursor& pointer);
  std::vector<std::string> render_words(const Cursor& pointer) const;
  void render_dialog(const Frame& frame, const Cursor& pointer);
  void render_progress(const Frame& frame, float width, float height);
  void closing_dialog(const Frame& frame);
  void film_button(const Frame& frame);
  void film_mark(const DrawingFacts& facts, float width, float height, float top);

  std::uint64_t post(std::string verb, std::vector<std::string> words = {}) {
    return post_(Action{std::move(verb), std::move(words)});
  }
  /// The item that was made last is of that name.
  void note_place(std::string what);

  Cursor::Post post_;
  std::vector<Place> places_;
  struct Asked {
    double value;
    std::uint64_t number;
  };
  std::map<std::string, Asked> asked_;
  std::uint64_t message_seen_ = 0;
  struct Note {
    std::string text;
    bool is_error;
    double until;  ///< s: when it goes
  };
  std::vector<Note> notes_;  ///< the latest ones, in their order
  bool meter_is_open_ = false;
  float meter_end_ = 0;  ///< y of its lower edge
  /// A slider that is pressed.
  struct Held {
    std::string id;
    double value = 0;
    double began = 0;  ///< s
    float x = 0;       ///< of the press
    bool moved = false, has_value = false;
  } held_;
  std::vector<std::string> files_;  ///< of the menu
  std::array<char, 512> path_{};    ///< typed there
  std::set<std::string> all_of_;    ///< panels of materials that show all controls
  std::string story_;
  struct RenderDialog {
    bool open = false, was_paused = false;
    std::string file;   ///< the scene's
    float seconds = 3;  ///< of the film
  } render_dialog_;
  std::map<std::string_view, double> hint_used_;  ///< s, by the hint: when what it says was done
  bool was_by_keyboard_ = false;
  std::string put_away_;  ///< the scene of a film whose end was seen
  bool asks_to_close_ = false, closes_ = false;
  LiveRange live_of_drag_{};  ///< of the slider that is dragged, as its drag began
  enum class Holds { no, slow, soft };
  Holds holds_ = Holds::no;  ///< whether it would go further, and why it does not
  bool edits_ = false;       ///< whether the control at hand has changed matter or gravity
  bool new_stage_ = false;   ///< whether another was asked for: the camera goes to its place
};

/// A length that is easy to read.
struct RoundLength {
  double meters;
  std::string text;  ///< "20 cm"
};
/// The largest of 1, 2 and 5 times a power of ten that is no longer than `most` [m], which is above
/// 0.
RoundLength round_length(double most);

/// The hints of the first minute, and the page of keys.
struct KeyHelp {
  std::string keys, what;
};
const std::vector<KeyHelp>& key_help();

}  // namespace dreampm::play
