// An HDF5 file that is written bit by bit, on a disk that may become full.
#pragma once
#include <filesystem>
#include <string>

#include "dreampm/io/archive_hdf5.h"

namespace dreampm::exchange {

/// HDF5 cannot close a file that it could not write, and crashes when the program ends. Here the
/// first write that fails is remembered, and HDF5 goes on as if all were well.
class Hdf5Output {
 public:
  /// `path` is written; errors name `target`, the file the user knows. Throws RunError.
  Hdf5Output(const std::filesystem::path& path, const std::filesystem::path& target);
  hid_t id() const { return file_; }
  const std::string& target() const { return target_; }
  /// Throws RunError with the system's reason if a write has failed.
  void check() const;
  /// Throws RunError with the system's reason, or with HDF5's own.
  [[noreturn]] void fail() const;

 private:
  int error_ = 0;  ///< the first errno
  std::string target_;
  H5Handle driver_, file_;
};

}  // namespace dreampm::exchange
