// Attributes of a USD text file that change over time. USD writes an attribute with all its samples
// before the next one, frames come one after the other: each attribute grows in a file of its own
// until the end.
#pragma once
#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dreampm/base/replacement.h"
#include "dreampm/io/byte_sink.h"
#include "dreampm/math/vec.h"

namespace dreampm::exchange {

class UsdSamples {
 public:
  /// `head`: the attribute's type and name; `metadata`: what stands in parentheses after them, may
  /// be empty.
  UsdSamples(const std::filesystem::path& target, std::size_t number, std::string head, std::string metadata = {});

  /// The value of a frame: a tuple for each row, plain numbers for rows of one.
  template <class T>
  void add(int frame, std::span<const T> values, std::size_t row = 1) {
    begin(frame);
    fmt::memory_buffer text;
    for (std::size_t i = 0; i < values.size(); i += row) {
      if (i > 0) text.append(std::string_view(", "));
      if (row > 1) text.push_back('(');
      for (std::size_t k = 0; k < row; ++k)
        fmt::format_to(std::back_inserter(text), "{}{}", k > 0 ? ", " : "", values[i + k]);
      if (row > 1) text.push_back(')');
      if (text.size() > buffered) out_.bytes(text.data(), text.size()), text.clear();
    }
    out_.bytes(text.data(), text.size());
    out_.text("],\n");
  }
  /// Vectors of three floats.
  void add(int frame, std::span<const Vec3f> values) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    add(frame, std::span<const float>(values.empty() ? nullptr : &values[0].x, 3 * values.size()), 3);
  }
  /// Appends all of it to the file, with `indent` before each line, and is done.
  void copy_to(ByteSink& file, const std::string& indent);

 private:
  static constexpr std::size_t buffered = std::size_t(1) << 20;
  void begin(int frame);
  std::string head_, metadata_;
  Replacement file_;
  ByteSink out_;
};

/// A name that USD takes: letters, digits and _, not beginning with a digit.
std::string usd_name(const std::string& name);

}  // namespace dreampm::exchange
