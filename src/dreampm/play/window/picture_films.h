// Films of the picture in a window: the one under way, one of the last seconds, and those that are
// still being encoded.
#pragma once
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/image.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/play/window/last_seconds.h"
#include "dreampm/play/window/recorder.h"

namespace dreampm::play {

/// No function waits for an encoder but where that is said.
class PictureFilms {
 public:
  /// Says to the user what became of a film.
  using Tell = std::function<void(const std::string& text, bool is_error)>;
  /// How films are encoded: encode_pictures, or what stands in for it.
  explicit PictureFilms(Tell tell, Recorder::Encode encode = encode_pictures);

  /// Adds the picture of a frame to the film that it asks for, and begins or ends that. `time`: s
  /// of any clock; while the encoder is behind it stands still, and no picture is taken. Throws
  /// what went wrong with the film, which has ended then.
  void record(const Frame& frame, double time, const std::function<RgbImage()>& picture);
  /// Whether the encoder is so far behind that the world should wait for it.
  bool is_behind() const;
  /// Waits until it is not.
  void wait_for_room() const;
  /// s of the film under way: its length, and what of it waits for the encoder.
  std::optional<double> seconds() const;
  double seconds_behind() const;

  /// Keeps a frame that was shown for a film of the last seconds.
  void keep(std::shared_ptr<const Frame> frame) { last_.keep(std::move(frame)); }
  /// A film of what was kept begins. It is drawn by go_on_with_last.
  void save_last(std::string file);
  /// Draws frames of it for a part of a picture's time, as far as the encoder keeps up.
  void go_on_with_last(const std::function<RgbImage(const Frame&)>& picture);

  /// Ends the film under way, also where frames still ask for it.
  void end();
  /// Says which films have become files, or failed, since the last call.
  void poll();
  /// Whether a film is, or will be, written to that file.
  bool is_in_use(const std::string& file) const;
  /// Whether all films are files.
  bool are_written() const { return !recorder_ && !saving_ && ending_.empty(); }
  /// Ends the film under way, and waits until all are files. Throws what went wrong.
  void finish();

 private:
  struct Saving {
    Recorder to;
    std::deque<LastSeconds::Shown> shown;
    std::size_t next = 0;
  };
  struct Ending {
    std::unique_ptr<Recorder> recorder;
    std::string done;  ///< what is said then
  };
  void begin(const Frame& frame, double time);
  /// Waits for the film where it is not done; says what became of it.
  void conclude(Ending& film);

  const Tell tell_;
  const Recorder::Encode encode_;
  std::unique_ptr<Recorder> recorder_;
  double clock_ = 0, last_time_ = 0;  ///< s, of the film and of the picture before
  bool stands_ = false;               ///< whether the picture before found no room
  std::string ended_;                 ///< the file of a film that has ended, while frames still ask for it
  LastSeconds last_;
  std::unique_ptr<Saving> saving_;  ///< the last seconds
  std::vector<Ending> ending_;
};

}  // namespace dreampm::play
