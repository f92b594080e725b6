#include "dreampm/import/ply_header.h"

#include <algorithm>
#include <charconv>
#include <fstream>

#include "dreampm/base/error.h"
#include "dreampm/import/gzip.h"

namespace dreampm {
namespace {

// More than any sane header; a file of garbage must not be searched whole to find no end in it.
constexpr std::size_t longest_header = std::size_t(1) << 16;

struct TypeName {
  PlyType type;
  const char *name, *other;
};
constexpr TypeName type_names[] = {{PlyType::int8, "char", "int8"},        {PlyType::uint8, "uchar", "uint8"},
                                   {PlyType::int16, "short", "int16"},     {PlyType::uint16, "ushort", "uint16"},
                                   {PlyType::int32, "int", "int32"},       {PlyType::uint32, "uint", "uint32"},
                                   {PlyType::float32, "float", "float32"}, {PlyType::float64, "double", "float64"}};

constexpr std::string_view blanks = " \t\r\v\f";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = line.find_first_not_of(blanks); i < line.size(); i = line.find_first_not_of(blanks, i)) {
    const std::size_t end = std::min(line.find_first_of(blanks, i), line.size());
    words.push_back(line.substr(i, end - i));
    i = end;
  }
  return words;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view text, std::uint64_t file_bytes, const std::string& file) : text_(text), file_(file) {
    header_.file_bytes = file_bytes;
  }

  PlyHeader parse() {
    if (text_.empty()) fail_input("{}: the file is empty, a PLY file is wanted", file_);
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
    first_line();
    for (;;) {
      const std::size_t end = text_.substr(0, longest_header).find(line_end_, at_);
      if (end == std::string_view::npos &&
          words_of(text_.substr(at_, 40)) != std::vector<std::string_view>{"end_header"})
        fail_input("{}: is cut short, or no PLY file: its header has no \"end_header\"", file_);
      std::string_view text = text_.substr(at_, end - at_);
      if (text.ends_with('\r')) text.remove_suffix(1);
      at_ = std::min(end, text_.size() - 1) + 1;
      ++number_;
      if (line(text)) break;
    }
    header_.data_offset = at_;
    return std::move(header_);
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) {
    throw InputError(fmt::format("{}:{}: {}", file_, number_, fmt::format(text, std::forward<Args>(args)...)));
  }

  // It also says how lines end: files of old Macs have no LF.
  void first_line() {
    const std::size_t end = text_.substr(0, longest_header).find_first_of("\r\n", at_);
    const std::string_view first = text_.substr(at_, std::min(end, text_.size()) - at_);
    if (words_of(first) != std::vector<std::string_view>{"ply"})
      fail_input("{}: is not a PLY file: it starts with \"{}\", not \"ply\"", file_, printable(first));
    if (end == std::string_view::npos) fail_input("{}: is cut short: it has no \"end_header\"", file_);
    const bool lone_cr = text_[end] == '\r' && !text_.substr(end + 1).starts_with('\n');
    line_end_ = lone_cr ? '\r' : '\n';
    at_ = text_.find(line_end_, end) + 1;
  }

  // Returns true at end_header.
  bool line(std::string_view text) {
    const std::vector<std::string_view> words = words_of(text);
    const std::string_view word = words.empty() ? "" : words[0];
    if (word == "comment") {
      const std::size_t at = text.find_first_not_of(blanks, text.find(word) + word.size());
      header_.comments.emplace_back(at < text.size() ? text.substr(at) : "");
    } else if (word.empty() || word == "obj_info") {
    } else if (word == "format") {
      format(words);
    } else if (!have_format_) {
      fail("\"{}\" where \"format\" must stand", printable(text));
    } else if (word == "element") {
      element(words);
    } else if (word == "property") {
      property(words, text);
    } else if (word != "end_header") {
      fail("\"{}\" is no PLY header line", printable(text));
    }
    return word == "end_header";
  }

  static std::string_view word_at(const std::vector<std::string_view>& words, std::size_t i) {
    return i < words.size() ? words[i] : std::string_view();
  }
  void expect_words(const std::vector<std::string_view>& words, std::size_t most) {
    if (words.size() > most) fail("\"{}\" follows where the line must end", printable(words[most]));
  }

  void format(const std::vector<std::string_view>& words) {
    const std::string_view name = word_at(words, 1), version = word_at(words, 2);
    if (have_format_) fail("a second \"format\" line");
    if (name == "ascii")
      header_.format = PlyFormat::ascii;
    else if (name == "binary_little_endian")
      header_.format = PlyFormat::binary_little_endian;
    else if (name == "binary_big_endian")
      header_.format = PlyFormat::binary_big_endian;
    else
      fail("format \"{}\" is not known: ascii, binary_little_endian or binary_big_endian", printable(name));
    if (version != "1.0") fail("PLY version \"{}\" is not known: 1.0 is wanted", printable(version));
    expect_words(words, 3);
    have_format_ = true;
  }

  void element(const std::vector<std::string_view>& words) {
    PlyElement e;
    e.name = word_at(words, 1);
    const std::string_view count = word_at(words, 2);
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), e.count);
    if (count.empty() || error != std::errc() || end != count.data() + count.size())
      fail("element {}: \"{}\" is no count", printable(e.name), printable(count));
    if (header_.find(e.name)) fail("element {} is there twice", printable(e.name));
    expect_words(words, 3);
    header_.elements.push_back(std::move(e));
  }

  PlyType type(std::string_view name) {
    for (const TypeName& t : type_names)
      if (name == t.name || name == t.other) return t.type;
    fail("type \"{}\" is not known: char, uchar, short, ushort, int, uint, float or double", printable(name));
  }

  void property(const std::vector<std::string_view>& words, std::string_view text) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyElement& e = header_.elements.back();
    PlyProperty p;
    p.list = word_at(words, 1) == "list";
    if (p.list) {
      p.count_type = type(word_at(words, 2));
      if (p.count_type == PlyType::float32 || p.count_type == PlyType::float64)
        fail("a list's length cannot be of type {}", words[2]);
    }
    const std::size_t at = p.list ? 3 : 1;
    p.type = type(word_at(words, at));
    p.name = word_at(words, at + 1);
    if (p.name.empty()) fail("\"{}\" names no property", printable(text));
    if (e.find(p.name)) fail("property {} of element {} is there twice", printable(p.name), printable(e.name));
    expect_words(words, at + 2);
    e.properties.push_back(std::move(p));
  }

  std::string_view text_;
  const std::string& file_;
  PlyHeader header_;
  std::size_t at_ = 0;
  char line_end_ = '\n';
  int number_ = 1;
  bool have_format_ = false;
};

// A count that the rest of the file cannot hold is refused here, before anything is allocated for
// it.
void check_counts(const std::string& file, const PlyHeader& header) {
  std::uint64_t left = header.file_bytes - header.data_offset;
  for (const PlyElement& e : header.elements) {
    if (e.properties.empty() && e.count > 0) fail_input("{}: element {} has no properties", file, printable(e.name));
    const bool ascii = header.format == PlyFormat::ascii;
    // The shortest text of a value is one digit and one separator; the last may lack its line end.
    const std::uint64_t row = ascii ? 2 * e.properties.size() : e.row_bytes();
    if (row > 0 && e.count > (left + (ascii ? 1 : 0)) / row)
      fail_input(
          "{}: element {} claims {} rows of at least {} bytes, but {} bytes are left: cut short (truncated), or a "
          "wrong count",
          file, printable(e.name), e.count, row, left);
    left -= std::min(left, e.count * row);
  }
}

PlyHeader checked_header(std::string_view text, std::uint64_t file_bytes, const std::string& name) {
  PlyHeader header = HeaderParser(text, file_bytes, name).parse();
  check_counts(name, header);
  return header;
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

const PlyProperty* PlyElement::corners() const {
  for (const PlyProperty& p : properties)
    if (p.list && (p.name == "vertex_indices" || p.name == "vertex_index")) return &p;
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

bool PlyHeader::has_faces() const {
  return std::any_of(elements.begin(), elements.end(), [](const PlyElement& e) { return e.count > 0 && e.corners(); });
}

PlyHeader parse_ply_header(std::string_view text, const std::string& name) {
  return checked_header(text, text.size(), name);
}

PlyHeader read_ply_header(const std::filesystem::path& path) {
  std::error_code ec;
  const std::uint64_t bytes = std::filesystem::file_size(path, ec);
  std::string head(ec ? 0 : static_cast<std::size_t>(std::min<std::uint64_t>(bytes, longest_header)), '\0');
  // If it cannot be read so, read_unpacked says why.
  if (ec || !std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size())) ||
      is_gzip(head))
    return parse_ply_header(read_unpacked(path), path.string());
  return checked_header(head, bytes, path.string());
}

std::string printable(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? out + ".." : out;
}

}  // namespace dreampm
