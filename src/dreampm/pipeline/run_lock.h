// One process at a time works in a run's folder, or several of a farm, each on frames of its own.
#pragma once
#include <filesystem>

namespace dreampm {

enum class LockKind { alone, shared };  ///< shared: with others that hold it so, and none that holds it alone

/// Holds a run's folder as long as it lives, by a lock on the file DIR/lock. The system drops the
/// lock with the process, however that ends; the file stays.
class RunLock {
 public:
  /// Makes the folder if it is not there. Throws InputError naming the process that holds it. Where
  /// the file system has no locks it warns and goes on.
  explicit RunLock(const std::filesystem::path& folder, LockKind kind = LockKind::alone);
  /// Removes a folder that it made, with the parents made for it, unless it is kept.
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  /// From now on the folder stays: it holds something.
  void keep() { made_.clear(); }

 private:
  void lock(const std::filesystem::path& folder);
  LockKind kind_;
  std::filesystem::path file_;
  std::filesystem::path made_;      ///< the folder, if it was not there
  std::filesystem::path existing_;  ///< of its parents the nearest that was there
  int descriptor_ = -1;
};

}  // namespace dreampm
