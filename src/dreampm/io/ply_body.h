// The values behind a PLY header, one after the other. Private to this room.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/io/ply.h"

namespace dreampm {

/// Reads header and body; then `next` walks through the values. Throws InputError on big-endian files and when the body
/// ends too early or holds no number.
class PlyBody {
 public:
  explicit PlyBody(const std::filesystem::path& file);

  const PlyHeader& header() const { return header_; }
  const std::string& file() const { return file_; }
  /// The next value. `element` and `row` are for the message.
  double next(PlyType type, const PlyElement& element, std::uint64_t row);
  /// Walks past one row.
  void skip_row(const PlyElement& element, std::uint64_t row);
  /// Calls take(row, values) for each row of an element without lists; values[i] is that of property i.
  template <class Take>
  void rows(const PlyElement& element, const Take& take) {
    std::vector<double> values(element.properties.size());
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = next(element.properties[i].type, element, row);
      take(static_cast<std::size_t>(row), values);
    }
  }
  /// Throws InputError unless all bytes were used (ascii: only blanks may follow).
  void expect_end() const;

 private:
  [[noreturn]] void fail_short(const PlyElement& element, std::uint64_t row) const;
  std::string file_;
  PlyHeader header_;
  std::string data_;
  std::size_t at_ = 0;
};

/// Where three properties stand in an element, if all three are there and are no lists.
std::optional<std::array<std::size_t, 3>> ply_triple(const PlyElement& element, const char* x, const char* y,
                                                     const char* z);
/// Where one property stands.
std::optional<std::size_t> ply_index(const PlyElement& element, std::string_view name);

inline Vec3f ply_vec(const std::vector<double>& values, const std::array<std::size_t, 3>& at) {
  return {static_cast<float>(values[at[0]]), static_cast<float>(values[at[1]]), static_cast<float>(values[at[2]])};
}

/// The header's line for ply_shift; empty for none.
std::string ply_shift_comment(const Vec3d& shift);

}  // namespace dreampm
