// Errors that a user sees. What is thrown decides the exit code of the command: InputError 2, RunError 1, Interrupted
// 130.
#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace dreampm {

/// Base of every error meant for a user. The text names the file, line, column or value, and what would be right.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  virtual int exit_code() const { return 1; }
};

/// Something the user gave is wrong: a scene, a mesh, an argument.
class InputError : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 2; }
};

/// The run itself failed: numbers, memory, disk.
class RunError : public Error {
 public:
  using Error::Error;
};

/// The user asked to stop (SIGINT, SIGTERM); state is saved before this is thrown.
class Interrupted : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 130; }
};

template <class... Args>
[[noreturn]] void fail_input(fmt::format_string<Args...> text, Args&&... args) {
  throw InputError(fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
[[noreturn]] void fail_run(fmt::format_string<Args...> text, Args&&... args) {
  throw RunError(fmt::format(text, std::forward<Args>(args)...));
}

/// The text of errno, for messages about files.
std::string system_reason();

}  // namespace dreampm
