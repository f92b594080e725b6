// A film of what is shown, encoded on a thread of its own while pictures come.
#pragma once
#include <condition_variable>
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

class Recorder {
 public:
  static constexpr double longest_stand = 5;  ///< s
  /// What add() does while the encoder is behind: it waits, or the picture before stands longer.
  enum class Behind { waits, leaves_out };
  /// How films are encoded: encode_pictures, or what stands in for it.
  using Encode = std::function<void(const std::function<std::optional<RgbImage>()>& next,
                                    const std::filesystem::path& file, const VideoSettings& settings)>;

  Recorder(std::filesystem::path file, double fps, Behind behind = Behind::waits, Encode encode = encode_pictures);
  /// Ends the film. What goes wrong then is a warning: finish() throws it.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The picture at that time [s] of any clock: it stands until the next one, so that the film is
  /// as fast as the clock; but no longer than longest_stand, such as while a window is minimised.
  /// All are made as large as the first, an odd row or column less: others lie in the middle.
  /// Throws what the encoder threw.
  void add(const RgbImage& picture, double time);
  /// Writes the file. Throws what the encoder threw.
  void finish();
  const std::filesystem::path& file() const { return file_; }
  double fps() const { return fps_; }
  /// Of film, until now.
  double seconds() const { return static_cast<double>(frames_) / fps_; }
  /// Whether add() would wait, or leave out a picture.
  bool is_behind() const;
  /// Pictures for which there was no time.
  long left_out() const { return left_out_; }

 private:
  struct Shown {
    RgbImage picture;
    long frames;  ///< for which it is shown
  };
  /// Whether the encoder will get it; else the picture before stands for those frames too.
  bool push(const RgbImage& picture, long frames);
  std::optional<RgbImage> next();
  void check();

  const std::filesystem::path file_;
  const double fps_;
  const Behind behind_;
  int width_ = 0, height_ = 0;
  double began_ = 0, last_time_ = 0;
  long frames_ = 0;  ///< of the film, until now
  long left_out_ = 0;
  RgbImage last_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Shown> waiting_;            ///< for the encoder
  bool ends_ = false, stopped_ = false;  ///< stopped_: the encoder takes no more
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace dreampm::play
