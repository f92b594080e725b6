#include "dreampm/pipeline/run_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <thread>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/log.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

/// The process that holds the lock; 0 if it has not written its number within a moment.
long holder(const fs::path& file) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    long process = 0;
    if (std::ifstream(file) >> process && process > 0) return process;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return 0;
}

/// Whether the open file is still the one of that name: a folder may have been removed in between.
bool is_there(int descriptor, const fs::path& file) {
  struct stat open{}, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

}  // namespace

RunLock::RunLock(const fs::path& folder, LockKind kind) : kind_(kind), file_(folder / "lock") {
  if (!fs::exists(folder)) {
    made_ = fs::absolute(folder).lexically_normal();
    if (!made_.has_filename()) made_ = made_.parent_path();
    existing_ = made_.parent_path();
    while (!fs::exists(existing_) && existing_.has_relative_path()) existing_ = existing_.parent_path();
  }
  try {
    lock(folder);
  } catch (...) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw;
  }
}

void RunLock::lock(const fs::path& folder) {
  while (true) {
    make_folder(folder);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) fail_input("{}: nothing may be written there: {}", folder.string(), system_reason());
    if (::flock(descriptor_, (kind_ == LockKind::alone ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) {
        warn("{}: cannot be locked ({}): make sure that no other process works in this folder", file_.string(),
             system_reason());
        keep();  // another process may write there
        return;
      }
      const long process = holder(file_);
      fail_input("{}: {} works in this folder; wait for it, or name another folder", folder.string(),
                 process > 0 ? fmt::format("process {}", process) : "another process");
    }
    if (is_there(descriptor_, file_)) break;
    ::close(descriptor_);
  }
  // Another process may have made the folder meanwhile, and filled it.
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != file_.filename()) keep();
  if (kind_ == LockKind::shared) return;  // no one process holds it
  const std::string process = fmt::format("{}\n", ::getpid());
  // For people only: on a full disk the lock holds all the same.
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, process.data(), process.size(), 0) < 0)
    warn("{}: cannot be written: {}", file_.string(), system_reason());
}

RunLock::~RunLock() {
  std::error_code ignored;
  if (!made_.empty()) {
    fs::remove_all(made_, ignored);
    // Parents that another run uses by now are not empty, and stay.
    for (fs::path parent = made_.parent_path(); parent != existing_ && fs::remove(parent, ignored);)
      parent = parent.parent_path();
  } else if (kind_ == LockKind::alone && ::ftruncate(descriptor_, 0) != 0) {
    warn("{}: cannot be written: {}", file_.string(), system_reason());
  }
  ::close(descriptor_);
}

}  // namespace dreampm
