// The values behind a PLY header, one after the other, of text and of binary files in either byte
// order.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/import/ply_header.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// Reads the header; then `next` walks through the values. `text` is the whole unpacked file and
/// must outlive this object, `name` is for messages. Throws InputError as parse_ply_header does,
/// and when the values end too early or one is no number.
class PlyValues {
 public:
  PlyValues(std::string_view text, const std::string& name);

  const PlyHeader& header() const { return header_; }
  const std::string& file() const { return name_; }
  /// The next value. `element` and `row` are for the message.
  double next(PlyType type, const PlyElement& element, std::uint64_t row);
  /// The next value as the length of the list `property`, which the rest of the file can hold.
  std::uint64_t list_length(const PlyProperty& property, const PlyElement& element, std::uint64_t row);
  /// Walks past one property, or one row.
  void skip(const PlyProperty& property, const PlyElement& element, std::uint64_t row);
  void skip_row(const PlyElement& element, std::uint64_t row);
  /// Calls take(row, values) for each row; values[i] is that of property i, 0 for a list.
  template <class Take>
  void rows(const PlyElement& element, const Take& take) {
    std::vector<double> values(element.properties.size());
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        const PlyProperty& p = element.properties[i];
        if (p.list)
          skip(p, element, row);
        else
          values[i] = next(p.type, element, row);
      }
      take(static_cast<std::size_t>(row), values);
    }
  }
  /// Bytes that were not used (ascii: blanks do not count).
  std::size_t left() const;
  /// Throws InputError unless left() is 0.
  void expect_end() const;

 private:
  [[noreturn]] void fail_short(const PlyElement& element, std::uint64_t row) const;
  std::string_view text_;
  std::string name_;
  PlyHeader header_;
  std::size_t at_ = 0;
};

/// Returns the indices of three properties in an element, if all three are there and are no lists.
std::optional<std::array<std::size_t, 3>> ply_triple(const PlyElement& element, const char* x, const char* y,
                                                     const char* z);
/// Returns the index of one property.
std::optional<std::size_t> ply_index(const PlyElement& element, std::string_view name);

inline Vec3d ply_point(const std::vector<double>& values, const std::array<std::size_t, 3>& at) {
  return {values[at[0]], values[at[1]], values[at[2]]};
}
inline Vec3f ply_vec(const std::vector<double>& values, const std::array<std::size_t, 3>& at) {
  return static_cast<Vec3f>(ply_point(values, at));
}

}  // namespace dreampm
