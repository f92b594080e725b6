#include "dreampm/farm/processes.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <map>
#include <thread>

#include "dreampm/base/error.h"
#include "dreampm/base/interrupt.h"

extern char** environ;  // NOLINT: posix_spawn wants it

namespace dreampm::farm {
namespace {

pid_t start(const Command& command) {
  std::vector<std::string> words = command.words;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, command.said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  // A group of its own: Ctrl-C is for this process, which then stops that one, once.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = -1;
  const int failure = ::posix_spawn(&child, words[0].c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failure != 0) fail_run("{}: cannot be started: {}", words[0], std::strerror(failure));
  return child;
}

/// Those that run, by their process; whatever happens, none is left.
class Running {
 public:
  Running() = default;
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() { stop(); }

  std::size_t count() const { return children_.size(); }
  void add(std::size_t index, const Command& command) { children_[start(command)] = index; }

  /// Calls `ended` for those that have.
  void look(const std::function<void(std::size_t, int)>& ended) {
    for (auto child = children_.begin(); child != children_.end();) {
      int status = 0;
      if (::waitpid(child->first, &status, WNOHANG) != child->first) {
        ++child;
        continue;
      }
      const std::size_t index = child->second;
      child = children_.erase(child);
      ended(index, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    }
  }

  void stop() {
    for (const auto& [child, index] : children_) ::kill(child, SIGTERM);
    for (const auto& [child, index] : children_)
      while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
      }
    children_.clear();
  }

 private:
  std::map<pid_t, std::size_t> children_;
};

}  // namespace

void run_all(const std::vector<Command>& commands, int jobs, const std::function<void(std::size_t, int)>& ended,
             const std::function<void()>& meanwhile) {
  Running running;
  auto shown = std::chrono::steady_clock::now();
  for (std::size_t next = 0; next < commands.size() || running.count() > 0;) {
    if (interrupted()) {
      running.stop();
      throw Interrupted("interrupted");
    }
    if (next < commands.size() && running.count() < static_cast<std::size_t>(jobs)) {
      running.add(next, commands[next]);
      ++next;
      continue;
    }
    running.look(ended);
    if (const auto now = std::chrono::steady_clock::now(); now - shown > std::chrono::seconds(1)) {
      meanwhile();
      shown = now;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace dreampm::farm
