#include <charconv>
#include <fstream>
#include <sstream>

#include "dreampm/base/error.h"
#include "dreampm/io/ply.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

// More than any sane header; a file of garbage must not be read whole to find no end in it.
constexpr std::size_t longest_header = std::size_t(1) << 16;

struct TypeName {
  PlyType type;
  const char *name, *other;
};
constexpr TypeName type_names[] = {{PlyType::int8, "char", "int8"},        {PlyType::uint8, "uchar", "uint8"},
                                   {PlyType::int16, "short", "int16"},     {PlyType::uint16, "ushort", "uint16"},
                                   {PlyType::int32, "int", "int32"},       {PlyType::uint32, "uint", "uint32"},
                                   {PlyType::float32, "float", "float32"}, {PlyType::float64, "double", "float64"}};

// Garbage in a message must not reach the terminal as control characters.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? out + ".." : out;
}

class HeaderParser {
 public:
  explicit HeaderParser(std::string file) : file_(std::move(file)) {}

  // Returns true at end_header.
  bool line(const std::string& text) {
    ++number_;
    std::istringstream in(text);
    std::string word;
    in >> word;
    if (number_ == 1) {
      if (text != "ply") fail_input("{}: not a PLY file: it starts with \"{}\", not \"ply\"", file_, shown(text));
    } else if (number_ == 2 && word != "format" && word != "comment") {
      fail("\"{}\" where \"format\" must stand", shown(text));
    } else if (word == "comment" || word == "obj_info") {
      const std::size_t at = text.find_first_not_of(" \t", text.find(word) + word.size());
      if (word == "comment") header.comments.push_back(at == std::string::npos ? "" : text.substr(at));
    } else if (word == "format") {
      format(in);
    } else if (word == "element") {
      element(in);
    } else if (word == "property") {
      property(in, text);
    } else if (word == "end_header") {
      if (!have_format_) fail("the header has no \"format\" line");
      return true;
    } else {
      fail("\"{}\" is no PLY header line", shown(text));
    }
    return false;
  }

  PlyHeader header;

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) {
    throw InputError(fmt::format("{}:{}: {}", file_, number_, fmt::format(text, std::forward<Args>(args)...)));
  }

  void format(std::istringstream& in) {
    std::string name, version;
    in >> name >> version;
    if (have_format_) fail("a second \"format\" line");
    if (name == "ascii")
      header.format = PlyFormat::ascii;
    else if (name == "binary_little_endian")
      header.format = PlyFormat::binary_little_endian;
    else if (name == "binary_big_endian")
      header.format = PlyFormat::binary_big_endian;
    else
      fail("format \"{}\" is not known: ascii, binary_little_endian or binary_big_endian", shown(name));
    if (version != "1.0") fail("PLY version \"{}\" is not known: 1.0 is wanted", shown(version));
    have_format_ = true;
  }

  void element(std::istringstream& in) {
    PlyElement e;
    std::string count;
    in >> e.name >> count;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), e.count);
    if (count.empty() || error != std::errc() || end != count.data() + count.size())
      fail("element {}: \"{}\" is no count", shown(e.name), shown(count));
    if (header.find(e.name)) fail("element {} is there twice", shown(e.name));
    header.elements.push_back(std::move(e));
  }

  PlyType type(const std::string& name) {
    for (const TypeName& t : type_names)
      if (name == t.name || name == t.other) return t.type;
    fail("type \"{}\" is not known: char, uchar, short, ushort, int, uint, float or double", shown(name));
  }

  void property(std::istringstream& in, const std::string& text) {
    if (header.elements.empty()) fail("a property before any element");
    PlyElement& e = header.elements.back();
    PlyProperty p;
    std::string word;
    in >> word;
    p.list = word == "list";
    if (p.list) {
      in >> word;
      p.count_type = type(word);
      if (p.count_type == PlyType::float32 || p.count_type == PlyType::float64)
        fail("a list's length cannot be of type {}", word);
      in >> word;
    }
    p.type = type(word);
    in >> p.name;
    if (p.name.empty()) fail("\"{}\" names no property", shown(text));
    if (e.find(p.name)) fail("property {} of element {} is there twice", shown(p.name), shown(e.name));
    e.properties.push_back(std::move(p));
  }

  std::string file_;
  int number_ = 0;
  bool have_format_ = false;
};

// A count that the rest of the file cannot hold is refused here, before anything is allocated for it.
void check_counts(const std::string& file, const PlyHeader& header) {
  std::uint64_t left = header.file_bytes - header.data_offset;
  for (const PlyElement& e : header.elements) {
    if (e.properties.empty() && e.count > 0) fail_input("{}: element {} has no properties", file, shown(e.name));
    const bool ascii = header.format == PlyFormat::ascii;
    // The shortest text of a value is one digit and one separator; the last may lack its line end.
    const std::uint64_t row = ascii ? 2 * e.properties.size() : e.row_bytes();
    if (row > 0 && e.count > (left + (ascii ? 1 : 0)) / row)
      fail_input(
          "{}: element {} claims {} rows of at least {} bytes, but {} bytes are left: truncated, or a wrong count",
          file, shown(e.name), e.count, row, left);
    left -= std::min(left, e.count * row);
  }
}

}  // namespace

std::size_t ply_size(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

const char* ply_name(PlyType type) {
  for (const TypeName& t : type_names)
    if (t.type == type) return t.name;
  return "?";
}

const PlyProperty* PlyElement::find(std::string_view property) const {
  for (const PlyProperty& p : properties)
    if (p.name == property) return &p;
  return nullptr;
}

bool PlyElement::has_list() const {
  for (const PlyProperty& p : properties)
    if (p.list) return true;
  return false;
}

std::size_t PlyElement::row_bytes() const {
  std::size_t sum = 0;
  for (const PlyProperty& p : properties) sum += ply_size(p.list ? p.count_type : p.type);
  return sum;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& e : elements)
    if (e.name == element) return &e;
  return nullptr;
}

PlyHeader read_ply_header(const fs::path& path) {
  const std::string file = path.string();
  std::error_code ec;
  if (fs::is_directory(path, ec)) fail_input("{}: is a folder, a PLY file is wanted", file);
  std::ifstream in(path, std::ios::binary);
  if (!in) fail_input("{}: cannot be read: {}", file, system_reason());
  const std::uint64_t bytes = fs::file_size(path, ec);
  if (ec) fail_input("{}: cannot be read: {}", file, ec.message());
  if (bytes == 0) fail_input("{}: the file is empty", file);
  std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, longest_header)), '\0');
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) fail_input("{}: cannot be read", file);

  HeaderParser parser(file);
  parser.header.file_bytes = bytes;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) {
      if (at == 0) parser.line(text.substr(0, 80));  // tells a file of garbage by its first line
      fail_input("{}: the header has no \"end_header\": truncated, or not a PLY file", file);
    }
    std::string line = text.substr(at, end - at);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    at = end + 1;
    if (parser.line(line)) {
      parser.header.data_offset = at;
      check_counts(file, parser.header);
      return std::move(parser.header);
    }
  }
}

}  // namespace dreampm
