// What the content of the window is made of. For the files of this module alone.
#pragma once
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/gl/objects.h"
#include "dreampm/play/model/size_chooser.h"
#include "dreampm/play/panels/key_help.h"
#include "dreampm/play/panels/pictures.h"
#include "dreampm/play/window/app.h"
#include "dreampm/play/window/last_seconds.h"
#include "dreampm/play/window/recorder.h"
#include "dreampm/play/window/view.h"

namespace dreampm::play {

struct App::Impl {
  Impl(const Cursor::Post& post, int threads, std::string isa, bool offscreen);
  ~Impl();

  struct KeyBinding;
  struct KeyRow;
  /// The one list of keys: what they do, and in words.
  static const std::vector<KeyRow>& key_rows();
  static const std::vector<KeyHelp>& key_words();
  /// What is seen beside the panels, of both sides while materials are compared, with the legend of
  /// its colors and its scale.
  RgbImage seen();
  /// What was drawn, into the film that the frame asks for, if it does.
  void film(const Frame& frame, double time);
  void end_film();
  /// A film of the last seconds begins to be written, beside what goes on.
  void save_last(const Frame& frame);
  /// Draws some of it, as the camera stands now, for a part of a picture's time.
  void go_on_with_last();
  /// The sides of a frame into their framebuffers; with the ring of the brush, where there
  /// is one.
  void draw_sides(const Frame& frame, int width, int height, const std::optional<CursorMark>& mark);
  // Of a picture, in this order.
  void set_look(const Frame& frame, float to);
  void feed_imgui(const Input& input, int width, int height);
  void lay_out(const Frame& frame, int width, int height);
  void keys(const Frame& frame, const Input& input);
  void released_keys(const Frame& frame, const Input& input);
  void move_cursor(const Frame& frame, const Input& input);
  /// What tools do.
  std::uint64_t use_tool(const Action& action) {
    panels.note_use(action.verb);
    return post(action);
  }
  /// Scenes, configs and records are opened; meshes fall in, of the chosen matter, over the pointer
  /// at that place of the picture under it.
  void drop_files(const Frame& under, const std::vector<std::string>& files, double x, double y);
  void shake(double x, double z);
  void set(const std::string& id, double value) { panels.host.set(id, value); }
  /// A key turns over what was asked for last, however late frames are.
  void toggle(const Frame& frame, const std::string& id, double value) {
    set(id, panels.host.asked(frame, id, value) == 0 ? 1 : 0);
  }

  Cursor::Post post;
  Cursor cursor;
  Panels panels;
  View view;
  Pictures pictures;
  DrawingFacts facts;
  const bool offscreen;
  /// How wide the picture of a side is in one of `width` pixels.
  static int side_width(const Frame& frame, int width) { return frame.other ? std::max(1, width / 2) : width; }
  std::unique_ptr<gl::Framebuffer> scene, window;
  std::unique_ptr<gl::Framebuffer> second;  ///< the picture of side B; null while nothing is compared
  std::unique_ptr<gl::Framebuffer> whole;   ///< of pictures that are saved
  bool over_second = false;                 ///< whether the pointer is, or was when a drag began
  std::unique_ptr<Recorder> recorder;
  LastSeconds last;
  struct Saving {
    Recorder to;
    std::deque<LastSeconds::Shown> shown;
    std::size_t next = 0;
  };
  std::unique_ptr<Saving> saving;       ///< the last seconds
  std::string failed_film;              ///< its file
  double last_time = -1, painted = -1;  ///< s, of the last input and picture
  double shown_for = 0;                 ///< s, of the picture before the last
  bool has_font = false, has_camera = false, dark = false, was_left = false, was_right = false, was_middle = false,
       wants_picture = false;
  bool chooses_size = false;
  SizeChooser chooser;
  float scale = 0;
  std::vector<int> late_releases;
  int scene_width = 1, scene_height = 1;  ///< of the picture, or that of a side
  int picture_width = 1;                  ///< of all sides
  int left = 0, bottom = 0;               ///< pixels that the panels take from the picture
};

}  // namespace dreampm::play
