#include "dreampm/import/ply_values.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY values are read and written as they lie in memory");

template <class T>
double raw(const char* p) {
  T v;
  std::memcpy(&v, p, sizeof v);
  return static_cast<double>(v);
}

double raw(PlyType type, const char* p) {
  switch (type) {
    case PlyType::int8:
      return raw<std::int8_t>(p);
    case PlyType::uint8:
      return raw<std::uint8_t>(p);
    case PlyType::int16:
      return raw<std::int16_t>(p);
    case PlyType::uint16:
      return raw<std::uint16_t>(p);
    case PlyType::int32:
      return raw<std::int32_t>(p);
    case PlyType::uint32:
      return raw<std::uint32_t>(p);
    case PlyType::float32:
      return raw<float>(p);
    case PlyType::float64:
      return raw<double>(p);
  }
  return 0;
}

bool blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\v' || c == '\f'; }

}  // namespace

PlyValues::PlyValues(std::string_view text, const std::string& name)
    : text_(text), name_(name), header_(parse_ply_header(text, name)), at_(header_.data_offset) {}

void PlyValues::fail_short(const PlyElement& element, std::uint64_t row) const {
  fail_input("{}: is cut short (truncated): it ends within element {}, row {} of {}", name_, printable(element.name),
             row + 1, element.count);
}

double PlyValues::next(PlyType type, const PlyElement& element, std::uint64_t row) {
  if (header_.format != PlyFormat::ascii) {
    const std::size_t size = ply_size(type);
    if (text_.size() - at_ < size) fail_short(element, row);
    const char* const from = text_.data() + at_;
    at_ += size;
    if (header_.format == PlyFormat::binary_little_endian) return raw(type, from);
    char turned[8];
    std::reverse_copy(from, from + size, turned);
    return raw(type, turned);
  }
  while (at_ < text_.size() && blank(text_[at_])) ++at_;
  if (at_ == text_.size()) fail_short(element, row);
  std::size_t end = at_;
  while (end < text_.size() && !blank(text_[end])) ++end;
  const std::string_view word = text_.substr(at_, end - at_);
  const char* const first = word.data() + (word[0] == '+' ? 1 : 0);
  double value = 0;
  const auto [stop, error] = std::from_chars(first, text_.data() + end, value);
  if (error == std::errc::result_out_of_range)  // from_chars leaves the value open
    value = word.find("e-") != word.npos || word.find("E-") != word.npos ? 0 : HUGE_VAL;
  else if (error != std::errc() || stop != text_.data() + end)
    fail_input("{}: element {}, row {}: \"{}\" is no number", name_, printable(element.name), row + 1, printable(word));
  at_ = end;
  return value;
}

std::uint64_t PlyValues::list_length(const PlyProperty& property, const PlyElement& element, std::uint64_t row) {
  const double length = next(property.count_type, element, row);
  const std::size_t least = header_.format == PlyFormat::ascii ? 1 : ply_size(property.type);
  if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>((text_.size() - at_) / least))
    fail_input(
        "{}: is cut short (truncated), or damaged: it ends within element {}, row {} of {}, before a list of {} "
        "numbers does",
        name_, printable(element.name), row + 1, element.count, length);
  return static_cast<std::uint64_t>(length);
}

void PlyValues::skip(const PlyProperty& property, const PlyElement& element, std::uint64_t row) {
  for (std::uint64_t n = property.list ? list_length(property, element, row) : 1; n > 0; --n)
    next(property.type, element, row);
}

void PlyValues::skip_row(const PlyElement& element, std::uint64_t row) {
  for (const PlyProperty& p : element.properties) skip(p, element, row);
}

std::size_t PlyValues::left() const {
  std::size_t at = at_;
  if (header_.format == PlyFormat::ascii)
    while (at < text_.size() && blank(text_[at])) ++at;
  return text_.size() - at;
}

void PlyValues::expect_end() const {
  if (const std::size_t bytes = left(); bytes > 0)
    fail_input("{}: {} bytes follow the last element: a damaged file or a wrong count", name_, bytes);
}

std::optional<std::size_t> ply_index(const PlyElement& element, std::string_view name) {
  const PlyProperty* p = element.find(name);
  if (!p || p->list) return std::nullopt;
  return static_cast<std::size_t>(p - element.properties.data());
}

std::optional<std::array<std::size_t, 3>> ply_triple(const PlyElement& element, const char* x, const char* y,
                                                     const char* z) {
  const auto a = ply_index(element, x), b = ply_index(element, y), c = ply_index(element, z);
  if (!a || !b || !c) return std::nullopt;
  return std::array<std::size_t, 3>{*a, *b, *c};
}

}  // namespace dreampm
