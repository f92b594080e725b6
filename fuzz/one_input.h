// What the fuzz targets share: what a reader may do with one input.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace dreampm::fuzz {

/// What each input is called in messages.
inline constexpr const char* input_name = "the-input";

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the process with this text, which libFuzzer takes for a find.
[[noreturn]] void fail(std::string_view text);

/// Calls read() for an input of `bytes`. It may return, or throw an InputError that names the input
/// (`name`; empty: any text will do), and nothing else. At no time may it hold more than 64 MiB and
/// `factor` times the input.
void read_one(std::size_t bytes, std::size_t factor, const std::function<void()>& read,
              std::string_view name = input_name);

/// Where this process may have a file in memory; nothing is there yet.
std::filesystem::path input_path(std::string_view extension);

/// The input as a file in memory, for readers that take a path. It is gone with this object.
class InputFile {
 public:
  InputFile(const std::uint8_t* data, std::size_t size, std::string_view extension);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace dreampm::fuzz
