// The folder for files of a bench that nobody keeps.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "dreampm/base/file.h"

namespace dreampm {

class TemporaryFolder {
 public:
  TemporaryFolder() : path(std::filesystem::temp_directory_path() / ("dreampm-bench-" + std::to_string(::getpid()))) {
    make_folder(path);
  }
  ~TemporaryFolder() {
    std::error_code ignored;  // a destructor may not throw; the folder lies among temporary files
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path path;
};

}  // namespace dreampm
