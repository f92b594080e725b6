// A file that grows over a while and is whole or absent, as replace_file's are.
#pragma once
#include <filesystem>

namespace dreampm {

/// Names a temporary file beside `target`. It becomes the target by `commit`; without that it is
/// removed, and an existing target is left as it was.
class Replacement {
 public:
  explicit Replacement(std::filesystem::path target);
  ~Replacement();
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Throws RunError with the reason.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
};

}  // namespace dreampm
