#include "dreampm/play/model/rendering.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>
#include <utility>

#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/base/seconds_since.h"
#include "dreampm/error.h"

extern char** environ;  // NOLINT: posix_spawn wants it

namespace dreampm::play {
namespace {

constexpr std::array<std::string_view, 4> stage_names{"simulate", "surface", "render", "video"};
constexpr int interrupted_code = 130;
/// s: how long a film may take to stop before that is said.
constexpr double silent = 0.5;

std::string reason(int code) { return std::strerror(code); }

/// An open file for as long as this lives.
class Open {
 public:
  explicit Open(const std::filesystem::path& file)
      : number_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {
    if (number_ < 0) throw InputError(fmt::format("{}: cannot be written: {}", file.string(), reason(errno)));
  }
  ~Open() { ::close(number_); }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// Of a process that ended.
int exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

}  // namespace

Rendering::Rendering(std::filesystem::path program, std::filesystem::path scene, std::string backend, bool goes_on,
                     std::chrono::milliseconds patience)
    : program_(std::move(program)),
      scene_(std::move(scene)),
      log_(std::filesystem::path(scene_).replace_extension(".log")),
      backend_(std::move(backend)),
      goes_on_(goes_on),
      patience_(patience),
      answer_(std::tmpfile(), &std::fclose) {
  if (!answer_) throw RunError(fmt::format("no temporary file can be made: {}", reason(errno)));
  status_.scene = scene_.string();
  start({"check", scene_.string(), "--json"}, ::fileno(answer_.get()));
}

Rendering::~Rendering() {
  using State = RenderStatus::State;
  // Of an estimate no file stays.
  if (status_.state == State::estimating || status_.state == State::estimated) discard();
  if (child_ <= 0) return;
  ::kill(child_, SIGINT);
  const auto began = Clock::now();
  bool is_said = false;
  while (::waitpid(child_, nullptr, WNOHANG) == 0) {
    if (seconds_since(began) > silent && !std::exchange(is_said, true))
      info("waiting up to {:.0f} s for the film to stop; dreampm make {} goes on with it",
           std::chrono::duration<double>(patience_).count(), status_.scene);
    if (Clock::now() - began > patience_) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void Rendering::start(const std::vector<std::string>& words, int output) {
  const Open log(log_);
  read_ = 0, line_.clear(), last_error_.clear(), printed_.clear();
  std::vector<std::string> line{program_.string()};
  line.insert(line.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : line) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output < 0 ? log.number() : output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, log.number(), STDERR_FILENO);
  // A group of its own: Ctrl-C in the terminal is for the window, which then ends this in order.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t usual;
  ::sigemptyset(&usual);
  ::sigaddset(&usual, SIGINT), ::sigaddset(&usual, SIGTERM);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  const int failure = ::posix_spawn(&child_, program_.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failure == 0) {
    // The window comes first.
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(child_), 10);
    return;
  }
  child_ = -1;
  throw RunError(fmt::format("{}: cannot be started: {}", program_.string(), reason(failure)));
}

void Rendering::make() {
  start({"make", scene_.string(), "--backend", backend_}, -1);
  status_.state = RenderStatus::State::running;
  stage_ = 0, stage_began_ = reported_ = Clock::now();
}

void Rendering::stop() {
  using State = RenderStatus::State;
  if (status_.state == State::estimating || status_.state == State::estimated) return discard();
  if (child_ <= 0 || stops_) return;
  stops_ = true;
  ::kill(child_, SIGINT);
}

void Rendering::discard() {
  if (child_ > 0) {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }
  status_.state = RenderStatus::State::stopped;
  std::error_code gone;
  for (const char* ending : {".yaml", ".start.h5", ".log"})
    std::filesystem::remove(std::filesystem::path(scene_).replace_extension(ending), gone);
}

void Rendering::leave() {
  child_ = -1;
  status_.state = RenderStatus::State::stopped;
}

const RenderStatus& Rendering::look() {
  if (child_ <= 0) return status_;
  int code = 0;
  const bool ended = ::waitpid(child_, &code, WNOHANG) == child_;
  read_log();
  if (ended)
    child_ = -1, end(exit_code(code));
  else if (status_.state == RenderStatus::State::running)
    expect_rest();
  return status_;
}

void Rendering::end(int code) {
  using State = RenderStatus::State;
  status_.left = 0;
  if (stops_ || code == interrupted_code) {
    status_.state = State::stopped;
    return;
  }
  if (code != 0) {
    status_.state = State::failed;
    status_.what =
        fmt::format("{}; see {}", last_error_.empty() ? fmt::format("exit code {}", code) : last_error_, log_.string());
    return;
  }
  if (status_.state == State::estimating) {
    read_estimate();
    if (status_.state != State::estimated || !goes_on_) return;
    try {
      make();
    } catch (const std::runtime_error& e) {
      status_.state = State::failed, status_.what = e.what();
    }
    return;
  }
  status_.state = State::done, status_.share = 1;
  const auto film =
      std::find_if(printed_.begin(), printed_.end(), [](const std::string& l) { return l.ends_with(".mp4"); });
  if (film != printed_.end()) status_.film = *film;
}

void Rendering::read_estimate() {
  std::string text;
  std::rewind(answer_.get());
  for (int c = std::fgetc(answer_.get()); c != EOF; c = std::fgetc(answer_.get())) text.push_back(static_cast<char>(c));
  try {
    const auto json = nlohmann::json::parse(text);
    status_.particles = json.at("particles"), status_.disk_bytes = json.at("disk_bytes");
    status_.memory_bytes = json.at("memory_bytes");
    for (std::size_t s = 0; s < stages; ++s) {
      expected_[s] = json.at("seconds").at(stage_names[s]);
      status_.seconds += expected_[s];
    }
    for (const std::string warning : json.at("warnings"))
      if (warning.find(" are free in ") != warning.npos) status_.what = warning;
    status_.state = RenderStatus::State::estimated;
  } catch (const nlohmann::json::exception& e) {
    status_.state = RenderStatus::State::failed;
    status_.what = fmt::format("the estimate cannot be read: {}", e.what());
  }
}

void Rendering::read_log() {
  std::ifstream file(log_, std::ios::binary);
  file.seekg(read_);
  for (char c = 0; file.get(c); ++read_) {
    if (c != '\n') {
      line_.push_back(c);
      continue;
    }
    read_line(line_);
    line_.clear();
  }
}

void Rendering::read_line(const std::string& line) {
  // As Progress writes them: "render: frame 3/48, 5 s left".
  static const std::regex progress("([a-z]+): frame ([0-9]+)/([0-9]+).*");
  printed_.push_back(line);
  if (line.find("error: ") != line.npos) last_error_ = line;
  std::smatch m;
  if (!std::regex_match(line, m, progress)) return;
  const auto stage = std::find(stage_names.begin(), stage_names.end(), m[1].str());
  if (stage == stage_names.end()) return;
  reported_ = Clock::now();
  const int done = std::stoi(m[2]);
  // A simulation that starts from a moment counts frames from that one on.
  if (status_.stage != *stage)
    stage_began_ = reported_, status_.stage = *stage, first_done_ = *stage == "simulate" ? done : 0;
  stage_ = static_cast<std::size_t>(stage - stage_names.begin());
  status_.done = done - first_done_, status_.frames = std::stoi(m[3]) - first_done_;
}

/// Between the lines of the log, which are seconds apart, the clock goes on.
void Rendering::expect_rest() {
  const double here = seconds_since(stage_began_);
  double whole = std::max(expected_[stage_], 1e-3);
  if (status_.done > 0) {
    const double reported = std::chrono::duration<double>(reported_ - stage_began_).count();
    if (reported > 1) whole = reported * status_.frames / status_.done;
  }
  const double left = std::max(whole - here, 0.0);
  double before = 0, after = 0;
  for (std::size_t s = 0; s < stage_; ++s) before += expected_[s];
  for (std::size_t s = stage_ + 1; s < stages; ++s) after += expected_[s];
  const double share =
      std::max(static_cast<double>(status_.done) / std::max(status_.frames, 1), std::min(here / whole, 0.99));
  status_.left = left + after;
  status_.share = std::max(status_.share, std::min((before + share * whole) / (before + whole + after), 0.99));
}

void show_film(const std::string& file) {
  std::string program = "xdg-open", name = file;
  char* const words[] = {program.data(), name.data(), nullptr};
  pid_t child = 0;
  // It gives the file to a player and ends at once.
  if (::posix_spawnp(&child, program.c_str(), nullptr, nullptr, words, environ) == 0)
    std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
}

}  // namespace dreampm::play
