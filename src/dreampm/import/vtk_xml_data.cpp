#include "dreampm/import/vtk_xml_data.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>

#include "dreampm/base/base64.h"
#include "dreampm/base/error.h"
#include "dreampm/import/raw_numbers.h"

namespace dreampm {
namespace {

/// Times that zlib packs at best, and a bit.
constexpr std::size_t most_packed = 1100;

/// Characters of base64 that so much is written in.
std::size_t encoded(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

}  // namespace

VtkXmlData::VtkXmlData(const pugi::xml_node& file, std::size_t file_bytes, std::string_view appended, bool raw,
                       std::string name)
    : appended_(appended),
      raw_(raw),
      swapped_(std::string_view(file.attribute("byte_order").value()) == "BigEndian"),
      wide_(std::string_view(file.attribute("header_type").value()) == "UInt64"),
      left_(0),
      name_(std::move(name)) {
  const std::string_view compressor = file.attribute("compressor").value();
  zlib_ = compressor == "vtkZLibDataCompressor";
  constexpr std::size_t shared = 100;  // arrays that may name the same bytes
  left_ = file_bytes * (zlib_ ? most_packed : shared);
  if (!zlib_ && !compressor.empty())
    fail_input("{}: is packed by {}; files packed by zlib or not at all are read", name_, compressor);
}

std::vector<double> VtkXmlData::values(const pugi::xml_node& array) {
  const std::string what = array.attribute("Name").value();
  std::vector<double> out = read(array, what);
  if (out.size() > left_) fail_input("{}: its arrays up to {} hold more than the file can", name_, what);
  left_ -= out.size();
  return out;
}

std::vector<double> VtkXmlData::read(const pugi::xml_node& array, const std::string& what) const {
  const std::string format = array.attribute("format").value();
  if (format == "ascii") return inline_text(array, what);
  const std::string_view type_name = array.attribute("type").value();
  const NumberType* const type = find_number_type(type_name);
  if (!type) fail_input("{}: its array {} is of type {}, which is not read", name_, what, type_name);
  std::string_view from;
  const bool appended = format == "appended";
  if (appended) {
    const std::size_t offset = array.attribute("offset").as_ullong();
    if (offset > appended_.size()) fail_input("{}: its array {} begins after the end of the file", name_, what);
    from = appended_.substr(offset);
  } else {
    from = array.child_value();
    from.remove_prefix(std::min(from.find_first_not_of(" \t\r\n"), from.size()));
  }
  const bool base64 = !(appended && raw_);
  const std::string data = zlib_ ? packed(from, base64, what) : bytes(from, base64, what);
  std::vector<double> out(data.size() / type->bytes);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = type->read(&data[i * type->bytes], swapped_);
  return out;
}

std::vector<double> VtkXmlData::inline_text(const pugi::xml_node& array, const std::string& what) const {
  std::vector<double> out;
  const std::string_view text = array.child_value();
  constexpr const char* blanks = " \t\r\n";
  for (std::size_t at = text.find_first_not_of(blanks); at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    double v = 0;
    const auto [stop, error] = std::from_chars(text.data() + at, text.data() + end, v);
    if (stop != text.data() + end || (error != std::errc() && error != std::errc::result_out_of_range))
      fail_input("{}: its array {} holds what is no number, value {}", name_, what, out.size());
    out.push_back(v);
    at = text.find_first_not_of(blanks, end);
  }
  return out;
}

std::size_t VtkXmlData::length(std::string_view header, std::size_t number, const std::string& what) const {
  const std::size_t size = wide_ ? 8 : 4;
  if (number >= header.size() / size) fail_input("{}: its array {} is cut short", name_, what);
  const char* const at = header.data() + number * size;
  return wide_ ? raw_number<std::uint64_t>(at, swapped_) : raw_number<std::uint32_t>(at, swapped_);
}

/// Returns bytes that are not packed: a length, then the bytes.
std::string VtkXmlData::bytes(std::string_view from, bool base64, const std::string& what) const {
  const std::size_t head = wide_ ? 8 : 4;
  const std::string start = base64 ? base64_decoded(from, head) : std::string(from.substr(0, head));
  const std::size_t n = length(start, 0, what);
  if (n > from.size()) fail_input("{}: its array {} is cut short", name_, what);
  std::string all = base64 ? base64_decoded(from, head + n) : std::string(from.substr(0, head + n));
  if (all.size() != head + n) fail_input("{}: its array {} is cut short", name_, what);
  return all.substr(head);
}

/// Blocks: their number, their length, that of the last one if it differs, and how long each is
/// packed; then the blocks. In base64 the head is for itself.
std::string VtkXmlData::packed(std::string_view from, bool base64, const std::string& what) const {
  const std::size_t one = wide_ ? 8 : 4;
  const auto part = [&](std::size_t bytes) {
    return base64 ? base64_decoded(from, bytes) : std::string(from.substr(0, bytes));
  };
  const std::size_t blocks = length(part(one), 0, what);
  if (blocks > from.size()) fail_input("{}: its array {} is cut short", name_, what);
  const std::size_t head = (3 + blocks) * one;
  const std::string lengths = part(head);
  const std::size_t whole = length(lengths, 1, what), last = length(lengths, 2, what);
  const std::string_view rest = from.substr(std::min(base64 ? encoded(head) : head, from.size()));
  std::size_t all = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t size = length(lengths, 3 + b, what);
    if (size > rest.size() - all) fail_input("{}: its array {} is cut short", name_, what);
    all += size;
  }
  const std::string data = base64 ? base64_decoded(rest, all) : std::string(rest.substr(0, all));
  std::string out;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t size = length(lengths, 3 + b, what), full = b + 1 == blocks && last > 0 ? last : whole;
    if (size > data.size() - at || full > most_packed * (size + 1))
      fail_input("{}: its array {} is cut short", name_, what);
    std::string block(full, '\0');
    uLongf filled = full;
    if (::uncompress(reinterpret_cast<Bytef*>(block.data()), &filled, reinterpret_cast<const Bytef*>(&data[at]),
                     size) != Z_OK ||
        filled != full)
      fail_input("{}: its array {} cannot be unpacked: it is damaged", name_, what);
    out += block;
    at += size;
  }
  return out;
}

}  // namespace dreampm
