#include "dreampm/io/ply_body.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

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

bool blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

PlyBody::PlyBody(const std::filesystem::path& path) : file_(path.string()), header_(read_ply_header(path)) {
  if (header_.format == PlyFormat::binary_big_endian)
    fail_input("{}: big-endian PLY is not read here: write it as binary_little_endian or ascii", file_);
  std::ifstream in(path, std::ios::binary);
  data_.resize(static_cast<std::size_t>(header_.file_bytes - header_.data_offset));
  in.seekg(static_cast<std::streamoff>(header_.data_offset));
  if (!in.read(data_.data(), static_cast<std::streamsize>(data_.size())))
    fail_input("{}: cannot be read to its end", file_);
}

void PlyBody::fail_short(const PlyElement& element, std::uint64_t row) const {
  fail_input("{}: ends within element {}, row {} of {}: truncated", file_, element.name, row + 1, element.count);
}

double PlyBody::next(PlyType type, const PlyElement& element, std::uint64_t row) {
  if (header_.format != PlyFormat::ascii) {
    const std::size_t size = ply_size(type);
    if (data_.size() - at_ < size) fail_short(element, row);
    const double value = raw(type, data_.data() + at_);
    at_ += size;
    return value;
  }
  while (at_ < data_.size() && blank(data_[at_])) ++at_;
  if (at_ == data_.size()) fail_short(element, row);
  std::size_t end = at_;
  while (end < data_.size() && !blank(data_[end])) ++end;
  double value = 0;
  const auto [stop, error] = std::from_chars(data_.data() + at_, data_.data() + end, value);
  if (error != std::errc() || stop != data_.data() + end)
    fail_input("{}: element {}, row {}: \"{}\" is no number", file_, element.name, row + 1,
               data_.substr(at_, std::min<std::size_t>(end - at_, 40)));
  at_ = end;
  return value;
}

void PlyBody::skip_row(const PlyElement& element, std::uint64_t row) {
  for (const PlyProperty& p : element.properties) {
    const double count = p.list ? next(p.count_type, element, row) : 1;
    for (double i = 0; i < count; ++i) next(p.type, element, row);
  }
}

void PlyBody::expect_end() const {
  std::size_t at = at_;
  if (header_.format == PlyFormat::ascii)
    while (at < data_.size() && blank(data_[at])) ++at;
  if (at != data_.size())
    fail_input("{}: {} bytes follow the last element: a damaged file or a wrong count", file_, data_.size() - at);
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

std::string ply_shift_comment(const Vec3d& shift) {
  return shift == Vec3d{} ? "" : fmt::format("comment shift {} {} {}\n", shift.x, shift.y, shift.z);
}

Vec3d ply_shift(const PlyHeader& header, const std::string& file) {
  constexpr std::string_view key = "shift ";
  Vec3d shift;
  for (const std::string& comment : header.comments) {
    if (!comment.starts_with(key)) continue;
    const char *at = comment.data() + key.size(), *const end = comment.data() + comment.size();
    for (int a = 0; a < 3; ++a) {
      while (at != end && *at == ' ') ++at;
      const auto [stop, error] = std::from_chars(at, end, shift[a]);
      if (error != std::errc() || !std::isfinite(shift[a]))
        fail_input("{}: \"comment {}\" does not read \"comment shift X Y Z\" with three numbers", file, comment);
      at = stop;
    }
  }
  return shift;
}

}  // namespace dreampm
