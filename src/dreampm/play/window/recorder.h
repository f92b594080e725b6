// A film of what is shown, encoded on a thread of its own while pictures come.
#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "dreampm/image.h"
#include "dreampm/video/encode.h"

namespace dreampm::play {

/// No picture that it was given is left out.
class Recorder {
 public:
  static constexpr double longest_stand = 5;  ///< s
  /// Pictures that may wait for the encoder; of large ones fewer, by the bytes that they take.
  static constexpr std::size_t most_waiting = 60;
  static constexpr std::size_t most_bytes = std::size_t{256} << 20;
  /// How films are encoded: encode_pictures, or what stands in for it.
  using Encode = std::function<void(const std::function<std::optional<RgbImage>()>& next,
                                    const std::filesystem::path& file, const VideoSettings& settings)>;

  Recorder(std::filesystem::path file, double fps, Encode encode = encode_pictures);
  /// Ends the film, and waits for it. What goes wrong then is a warning: finish() throws it.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The picture at that time [s] of any clock: it stands until the next one, so that the film is
  /// as fast as the clock; but no longer than longest_stand, such as while a window is minimised.
  /// All are made as large as the first, an odd row or column less: others lie in the middle. Waits
  /// while there is no room for it. Throws what the encoder threw.
  void add(const RgbImage& picture, double time);
  /// Whether add() would not wait: the encoder keeps up.
  bool has_room() const;
  void wait_for_room();
  /// There are no more pictures: what waits is encoded, and the file written, beside what goes on.
  void end();
  /// Whether the file is there, or it failed: finish() would not wait.
  bool is_done() const;
  /// Ends the film, and waits for its file. Throws what the encoder threw.
  void finish();

  const std::filesystem::path& file() const { return file_; }
  double fps() const { return fps_; }
  /// s of film, until now.
  double seconds() const { return static_cast<double>(frames_) / fps_; }
  /// s of film that wait for the encoder.
  double behind() const;

 private:
  struct Shown {
    RgbImage picture;
    long frames;  ///< for which it is shown
  };
  bool is_full() const;
  void push(const RgbImage& picture);
  /// The picture before is shown for that number of frames more.
  void repeat(long frames);
  std::optional<RgbImage> next();
  void check();

  const std::filesystem::path file_;
  const double fps_;
  int width_ = 0, height_ = 0;
  double began_ = 0, last_time_ = 0;
  long frames_ = 0;  ///< of the film, until now
  RgbImage last_;
  bool last_is_pushed_ = false;  ///< or it came too soon after the one before
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Shown> waiting_;            ///< for the encoder
  bool ends_ = false, stopped_ = false;  ///< stopped_: the encoder takes no more
  std::exception_ptr failure_;
  bool is_thrown_ = false;  ///< whether somebody got the failure
  std::thread thread_;
};

}  // namespace dreampm::play
