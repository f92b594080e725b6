// Errors that a user sees. What is thrown decides the exit code of the command: InputError 2,
// RunError 1, Interrupted 130.
#pragma once
#include <stdexcept>

namespace dreampm {

/// Base of every error meant for a user. The text names the file, line, column or value, and what
/// would be right.
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

/// The numbers of a step stopped being numbers, or a step cannot be taken. The text names cause and
/// remedy.
class NumericalFailure : public RunError {
 public:
  using RunError::RunError;
};

/// The user asked to stop (SIGINT, SIGTERM); state is saved before this is thrown.
class Interrupted : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 130; }
};

}  // namespace dreampm
