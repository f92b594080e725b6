// Writes a file in large pieces and checks every one. For use inside replace_file.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace dreampm {

class ByteSink {
 public:
  /// `path` is written; errors name `target`, the file the user knows.
  ByteSink(const std::filesystem::path& path, const std::filesystem::path& target);
  ~ByteSink();
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;

  void text(std::string_view s) { bytes(s.data(), s.size()); }
  template <class T>
    requires std::is_trivially_copyable_v<T>
  void value(const T& v) {
    bytes(&v, sizeof v);
  }
  void bytes(const void* data, std::size_t size);
  /// Writes what is left and closes. Throws RunError with the reason; so do the others.
  void close();

 private:
  void flush();
  [[noreturn]] void fail();
  std::string target_;
  int file_;
  std::string buffer_;
};

}  // namespace dreampm
