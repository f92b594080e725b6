#include "one_input.h"

#include <fmt/format.h>
#include <sanitizer/allocator_interface.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "dreampm/base/file.h"
#include "dreampm/error.h"

namespace dreampm::fuzz {
namespace {

/// Counts what is held since start(). The sanitizer's hooks take functions alone, hence the one of
/// it.
class HeldMemory {
 public:
  static HeldMemory& one() {
    static HeldMemory memory;
    return memory;
  }
  void start(std::size_t most) { held_ = 0, most_ = static_cast<std::ptrdiff_t>(most); }
  void stop() { most_ = 0; }

 private:
  HeldMemory() { __sanitizer_install_malloc_and_free_hooks(taken, given_back); }
  static void taken(const volatile void*, std::size_t size) { one().add(static_cast<std::ptrdiff_t>(size)); }
  static void given_back(const volatile void* p) {
    if (p != nullptr) one().add(-static_cast<std::ptrdiff_t>(__sanitizer_get_allocated_size(const_cast<void*>(p))));
  }
  void add(std::ptrdiff_t bytes) {
    const std::ptrdiff_t most = most_;
    if (most == 0) return;
    const std::ptrdiff_t held = held_ += bytes;
    if (held <= most) return;
    most_ = 0;
    std::fprintf(stderr, "FOUND: holds %td bytes, %td are the most for this input\n", held, most);
    std::abort();
  }
  std::atomic<std::ptrdiff_t> held_ = 0, most_ = 0;
};

}  // namespace

void fail(std::string_view text) {
  std::fprintf(stderr, "FOUND: %.*s\n", static_cast<int>(text.size()), text.data());
  std::abort();
}

void read_one(std::size_t bytes, std::size_t factor, const std::function<void()>& read, std::string_view name) {
  HeldMemory& memory = HeldMemory::one();
  memory.start((std::size_t(64) << 20) + factor * bytes);
  try {
    read();
  } catch (const InputError& e) {
    if (std::string_view(e.what()).find(name) == std::string_view::npos)
      fail(fmt::format("a message that does not name the input: {}", e.what()));
  } catch (const std::exception& e) {
    fail(fmt::format("an error that is no InputError: {}", e.what()));
  }
  memory.stop();
}

std::filesystem::path input_path(std::string_view extension) {
  return fmt::format("/dev/shm/{}-{}{}", input_name, ::getpid(), extension);
}

InputFile::InputFile(const std::uint8_t* data, std::size_t size, std::string_view extension)
    : path_(input_path(extension)) {
  write_bytes(path_, data, size);
}

InputFile::~InputFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace dreampm::fuzz
