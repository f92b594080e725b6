// Films by the program ffmpeg, which reads the pictures from a socket.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/video/encoder.h"

extern char** environ;  // NOLINT: posix_spawn wants it

namespace dreampm {
namespace {

/// The same film as the libraries make: see libav_encoder.cpp.
std::vector<std::string> command_line(const std::filesystem::path& program, const FilmFile& film) {
  const std::string fps = fmt::format("{}", film.settings.fps);
  // Without -xerror it ends as if well when the disk is full.
  std::vector<std::string> line{program.string(), "-v", "error", "-nostdin", "-xerror", "-y"};
  const auto add = [&](std::initializer_list<std::string> words) { line.insert(line.end(), words); };
  add({"-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", fmt::format("{}x{}", film.width, film.height)});
  add({"-framerate", fps, "-i", "pipe:0"});
  add({"-vf",
       "scale=in_range=pc:out_range=tv:out_color_matrix=bt709:flags=bicubic+accurate_rnd+full_chroma_inp,"
       "format=yuv420p"});
  add({"-c:v", "libx264", "-crf", fmt::format("{}", film.settings.quality)});
  add({"-preset", film.settings.quick ? "veryfast" : "medium"});
  add({"-g", fmt::format("{}", group_size(film.settings.fps)), "-threads", "4"});
  add({"-color_range", "tv", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"});
  // The name as it is, whatever stands in it.
  add({"-movflags", "+faststart", "-f", "mp4", "file:" + film.temporary.string()});
  return line;
}

class ProgramEncoder final : public Encoder {
 public:
  ProgramEncoder(const std::filesystem::path& program, const FilmFile& film)
      : program_(program.string()), name_(film.target.string()), said_(std::tmpfile(), &std::fclose) {
    std::array<int, 2> ends{};
    if (!said_ || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      fail_run("{}: the video cannot be written: {}", name_, system_reason());
    pictures_ = ends[0];
    const int failure = start(command_line(program, film), ends[1]);
    ::close(ends[1]);
    if (failure == 0) return;
    ::close(pictures_);
    fail_run("{}: cannot be started: {}", program_, std::strerror(failure));
  }
  ~ProgramEncoder() override {
    close_pictures();
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    wait();
  }
  ProgramEncoder(const ProgramEncoder&) = delete;
  ProgramEncoder& operator=(const ProgramEncoder&) = delete;

  void add(const RgbImage& picture) override {
    const std::uint8_t* from = picture.pixels.data();
    for (std::size_t left = picture.pixels.size(); left > 0;) {
      const ssize_t sent = ::send(pictures_, from, left, MSG_NOSIGNAL);
      if (sent > 0) {
        from += sent, left -= static_cast<std::size_t>(sent);
      } else if (errno != EINTR) {
        // It ended before it had all pictures, and said why.
        close_pictures();
        fail(wait());
      }
    }
  }

  void finish() override {
    close_pictures();
    if (const int status = wait(); status != 0) fail(status);
  }

 private:
  int start(std::vector<std::string> line, int input) {
    std::vector<char*> arguments;
    for (std::string& word : line) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ::fileno(said_.get()), STDERR_FILENO);
    // A group of its own: Ctrl-C is for this process, which then ends that one.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    const int failure = ::posix_spawn(&child_, program_.c_str(), &files, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (failure != 0) child_ = -1;
    return failure;
  }

  void close_pictures() {
    if (pictures_ >= 0) ::close(pictures_);
    pictures_ = -1;
  }

  int wait() {
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    return status;
  }

  [[noreturn]] void fail(int status) const {
    std::string said(2000, '\0');
    std::rewind(said_.get());
    said.resize(std::fread(said.data(), 1, said.size(), said_.get()));
    while (!said.empty() && said.back() == '\n') said.pop_back();
    if (said.empty()) said = WIFSIGNALED(status) ? "it was killed" : "it did not say why";
    fail_run("{}: the video cannot be written: {}: {}", name_, program_, said);
  }

  std::string program_, name_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> said_;
  int pictures_ = -1;
  pid_t child_ = -1;
};

}  // namespace

std::unique_ptr<Encoder> open_program_encoder(const std::filesystem::path& program, const FilmFile& film) {
  return std::make_unique<ProgramEncoder>(program, film);
}

}  // namespace dreampm
