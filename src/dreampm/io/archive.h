// A container of named arrays and values in one HDF5 file, for checkpoints. Use from one thread at
// a time.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace dreampm {

/// The identity that a file states. A reader asks for `format` and `version`; `scene_hash` ties a
/// checkpoint to its scene.
struct ArchiveIdentity {
  std::string format;  ///< such as "dreampm-checkpoint"
  std::uint32_t version = 1;
  std::string scene_hash;
};

template <class T>
concept ArchiveValue = std::is_same_v<T, float> || std::is_same_v<T, double> || std::is_same_v<T, std::int32_t> ||
                       std::is_same_v<T, std::uint32_t> || std::is_same_v<T, std::uint64_t> ||
                       std::is_same_v<T, std::int64_t> || std::is_same_v<T, std::uint8_t>;

/// A writer of archives, made by write_archive alone. Names may hold '/' to group. Everything is
/// stored bit for bit (NaN payloads, -0). Throws RunError with the reason if the file cannot be
/// written, InputError on a name used twice.
class ArchiveWriter {
 public:
  template <ArchiveValue T>
  void add(const std::string& name, std::span<const T> values);
  template <ArchiveValue T>
  void add(const std::string& name, const std::vector<T>& values) {
    add(name, std::span<const T>(values));
  }
  template <ArchiveValue T>
  void add(const std::string& name, T value) {
    add(name, std::span<const T>(&value, 1));
  }
  void add(const std::string& name, const std::string& text);
  void add(const std::string& name, const char* text) { add(name, std::string(text)); }

 private:
  friend void write_archive(const std::filesystem::path&, const ArchiveIdentity&,
                            const std::function<void(ArchiveWriter&)>&);
  struct Impl;
  explicit ArchiveWriter(Impl& impl) : impl_(impl) {}
  Impl& impl_;
};

/// Writes a file through replace_file: `fill` adds the contents. On any error no new file appears.
/// Needs about twice the size of the contents in memory until it returns.
void write_archive(const std::filesystem::path& file, const ArchiveIdentity& identity,
                   const std::function<void(ArchiveWriter&)>& fill);

class ArchiveReader {
 public:
  /// Opens and checks. Throws InputError saying which: missing, not an archive, truncated, damaged
  /// (a checksum of the whole file is compared), another format or version.
  ArchiveReader(const std::filesystem::path& file, const std::string& format, std::uint32_t version);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  /// The format that a file says it is of. Throws InputError as the constructor does.
  static std::string format_of(const std::filesystem::path& file);

  const std::string& scene_hash() const;
  /// Throws InputError unless the file was written for this scene.
  void expect_scene(const std::string& hash) const;

  /// Names in alphabetical order, with their groups ("water/x").
  std::vector<std::string> keys() const;
  bool has(const std::string& name) const;
  /// The whole array. Throws InputError if it is missing or of another type.
  template <ArchiveValue T>
  std::vector<T> read(const std::string& name) const;
  /// The same, refusing any length but `count`.
  template <ArchiveValue T>
  std::vector<T> read(const std::string& name, std::size_t count) const;
  /// An array of one.
  template <ArchiveValue T>
  T value(const std::string& name) const {
    return read<T>(name, 1).front();
  }
  std::string text(const std::string& name) const;
  /// Throws InputError: what is called so is damaged, and why.
  [[noreturn]] void refuse(const std::string& name, const std::string& why) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dreampm
