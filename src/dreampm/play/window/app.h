// The whole content of the playground's window, in whatever context of OpenGL is current: picture,
// panels, pointer and keys. The window and the headless player put their input in.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "dreampm/image.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/panels/panels.h"
#include "dreampm/play/tools/cursor.h"

namespace dreampm::play {

/// A key, by the character on it, or one of the names below.
enum class Key : int { escape = 256, enter, tab, backspace, remove, left, right, up, down, home, end, f1, f6, f12 };

/// What came in since the last picture. Positions in pixels from the upper left corner.
struct Input {
  double time = 0;  ///< s, of any clock
  double x = 0, y = 0;
  bool inside = false;  ///< whether the pointer is in the window
  bool left = false, middle = false, right = false, control = false, shift = false;
  double wheel = 0;
  std::vector<int> pressed, released;  ///< keys: capital letters, digits, signs, or Key
  std::vector<int> repeated;           ///< of those that are held, as the system repeats them
  std::string text;                    ///< typed
  std::vector<std::string> files;      ///< dropped into the window, at the pointer
};

class App {
 public:
  /// `offscreen`: draws where there is no window, for `picture`.
  App(Cursor::Post post, int threads, std::string backend, bool offscreen = false);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  /// Takes the input into a window of that size, and lays its panels out. `scale`: of letters and
  /// panels.
  void update(const Frame& frame, const Input& input, int width, int height, float scale);
  /// Draws what was updated last.
  void paint(const Frame& frame, const Input& input, int width, int height);
  /// Both.
  void draw(const Frame& frame, const Input& input, int width, int height, float scale);
  /// What is shown from now on: kept for a film of the last seconds, which a key asks for.
  void keep(std::shared_ptr<const Frame> frame);
  /// Whether panels are drawn; else the picture is as large as the window.
  void show_panels(bool shown);
  /// Whether scenes that are opened have fewer particles where the machine does not keep up.
  void choose_size(bool chooses);
  /// Ends the film that is being made of what is drawn, and waits until all films are written.
  /// Throws what went wrong with them.
  void finish_films();
  /// The same for a window that closes, without waiting: whether they are. Until then it says so.
  bool close_films(const Frame& frame);
  /// Whether a film is so far behind that the world should wait for its encoder.
  bool is_film_behind() const;
  /// The whole window as it was drawn last, panels included, where it is off the screen.
  RgbImage picture() const;
  /// The same without panels, but with the legend and the scale of the picture.
  RgbImage view();
  /// Where the things to click stand that were drawn last.
  const std::vector<Place>& places() const;
  /// s, of the clock of the input: panels change by themselves up to then.
  double moves_until() const;
  /// Something that the window did, for its messages.
  void tell(const std::string& what, bool is_error = false);
  /// Set where somebody asked for a picture by key, until it is read.
  bool wants_picture();
  /// Whether the window may close now, which somebody asked for.
  bool may_close(const Frame& frame);
  /// Whether a dialog asks about that.
  bool asks_to_close() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace dreampm::play
