#include "dreampm/geometry/ply.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Format { ascii, little, big };
enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count;  // a list
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};
struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
};

std::size_t size_of(Type t) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(t)];
}

std::optional<Type> type_named(std::string_view word) {
  constexpr std::pair<std::string_view, Type> names[] = {
      {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
      {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
      {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
      {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64}};
  for (const auto& [name, type] : names)
    if (name == word) return type;
  return std::nullopt;
}

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && blank(line[i])) ++i;
    std::size_t end = i;
    while (end < line.size() && !blank(line[end])) ++end;
    if (end > i) words.push_back(line.substr(i, end - i));
    i = end;
  }
  return words;
}

/// What can be shown of a word from an unknown file.
std::string shown(std::string_view word) {
  std::string text;
  for (const char c : word.substr(0, 30)) text += c >= ' ' && c <= '~' ? c : '?';
  return text;
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Header header() {
    if (text_.empty()) fail_input("{}: is empty, a PLY file is wanted", name_);
    if (words_of(line()) != std::vector<std::string_view>{"ply"})
      fail_input("{}: is not a PLY file (it does not start with a line \"ply\")", name_);
    Header h;
    bool format = false;
    for (;;) {
      const auto words = words_of(line());
      if (at_ == text_.size() && (words.empty() || words[0] != "end_header"))
        fail_input("{}: is cut short: its PLY header has no end_header", name_);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3) {
        format = true;
        if (words[1] == "ascii")
          h.format = Format::ascii;
        else if (words[1] == "binary_little_endian")
          h.format = Format::little;
        else if (words[1] == "binary_big_endian")
          h.format = Format::big;
        else
          fail_input("{}:{}: PLY format \"{}\": ascii, binary_little_endian or binary_big_endian is wanted", name_,
                     line_, shown(words[1]));
      } else if (words[0] == "element" && words.size() == 3) {
        Element e;
        e.name = words[1];
        const auto [end, ec] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), e.count);
        if (ec != std::errc() || end != words[2].data() + words[2].size())
          fail_input("{}:{}: {} elements of \"{}\": a whole number is wanted", name_, line_, shown(words[2]),
                     shown(words[1]));
        h.elements.push_back(std::move(e));
      } else if (words[0] == "property" && words.size() >= 3 && !h.elements.empty()) {
        property(words, h.elements.back());
      } else {
        fail_input("{}:{}: \"{}\" is nothing that belongs into a PLY header", name_, line_, shown(words[0]));
      }
    }
    if (!format) fail_input("{}: its PLY header has no format line", name_);
    format_ = h.format;
    return h;
  }

  /// Refuses counts that what is left of the file cannot hold.
  void check_room(const Element& e) const {
    std::uint64_t least = 0;  // bytes an element takes at least; in ASCII a digit and a blank for each number
    for (const Property& p : e.properties) least += format_ == Format::ascii ? 2 : size_of(p.count.value_or(p.type));
    if (least == 0) return;
    const std::uint64_t left = text_.size() - at_ + (format_ == Format::ascii ? 1 : 0);  // the last blank may lack
    if (e.count > left / least)
      fail_input(
          "{}: promises {} elements of \"{}\", but the {} bytes that follow hold at most {}; it is cut short or broken",
          name_, e.count, shown(e.name), text_.size() - at_, left / least);
  }

  double number(Type type, const char* what, std::uint64_t index) {
    if (format_ != Format::ascii) return binary(type, what, index);
    while (at_ < text_.size() && blank(text_[at_])) ++at_;
    if (at_ == text_.size()) cut_short(what, index);
    std::size_t end = at_;
    while (end < text_.size() && !blank(text_[end])) ++end;
    const char* first = text_.data() + at_ + (text_[at_] == '+' ? 1 : 0);
    double value = 0;
    const auto [stop, ec] = std::from_chars(first, text_.data() + end, value);
    if (ec == std::errc::result_out_of_range) {
      value = 0;  // from_chars leaves it open: too small is 0, too large is caught as not finite
      if (std::string_view(first, std::size_t(stop - first)).find("e-") == std::string_view::npos &&
          std::string_view(first, std::size_t(stop - first)).find("E-") == std::string_view::npos)
        value = HUGE_VAL;
    } else if (ec != std::errc() || stop != text_.data() + end) {
      fail_input("{}: \"{}\" in {} {} is not a number", name_, shown(text_.substr(at_, end - at_)), what, index);
    }
    at_ = end;
    return value;
  }

  /// Length of a list; `type` is that of its items.
  std::uint64_t list_length(Type count, Type type, const char* what, std::uint64_t index) {
    const double n = number(count, what, index);
    const std::size_t least = format_ == Format::ascii ? 1 : size_of(type);
    if (!(n >= 0) || n != std::floor(n) || n > double((text_.size() - at_) / least))
      fail_input("{}: a list of {} numbers in {} {} does not fit into the file; it is cut short or broken", name_, n,
                 what, index);
    return static_cast<std::uint64_t>(n);
  }

  [[noreturn]] void cut_short(const char* what, std::uint64_t index) const {
    fail_input("{}: is cut short: it ends within {} {}", name_, what, index);
  }

 private:
  std::string_view line() {
    ++line_;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view l = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    return l;
  }
  void property(const std::vector<std::string_view>& words, Element& e) {
    Property p{std::string(words.back()), Type::f32, std::nullopt};
    const bool list = words[1] == "list";
    if (words.size() != (list ? 5u : 3u))
      fail_input("{}:{}: this PLY property has {} words", name_, line_, words.size());
    const auto type = type_named(words[list ? 3 : 1]);
    if (!type) fail_input("{}:{}: PLY has no type \"{}\"", name_, line_, shown(words[list ? 3 : 1]));
    p.type = *type;
    if (list) {
      p.count = type_named(words[2]);
      if (!p.count || *p.count == Type::f32 || *p.count == Type::f64)
        fail_input("{}:{}: \"{}\" cannot count a PLY list; a whole number type is wanted", name_, line_,
                   shown(words[2]));
    }
    e.properties.push_back(std::move(p));
  }
  double binary(Type type, const char* what, std::uint64_t index) {
    const std::size_t n = size_of(type);
    if (text_.size() - at_ < n) cut_short(what, index);
    char bytes[8] = {};
    for (std::size_t i = 0; i < n; ++i) bytes[i] = text_[at_ + (format_ == Format::big ? n - 1 - i : i)];
    at_ += n;
    const auto as = [&]<class T>(T value) {
      std::memcpy(&value, bytes, sizeof value);
      return static_cast<double>(value);
    };
    switch (type) {
      case Type::i8:
        return as(std::int8_t{});
      case Type::u8:
        return as(std::uint8_t{});
      case Type::i16:
        return as(std::int16_t{});
      case Type::u16:
        return as(std::uint16_t{});
      case Type::i32:
        return as(std::int32_t{});
      case Type::u32:
        return as(std::uint32_t{});
      case Type::f32:
        return as(float{});
      case Type::f64:
        return as(double{});
    }
    return 0;
  }

  std::string_view text_;
  const std::string& name_;
  Format format_ = Format::ascii;
  std::size_t at_ = 0;
  int line_ = 0;
};

void read_vertices(Reader& in, const Element& e, const std::string& name, PlyContent& content) {
  int axis_of[3] = {-1, -1, -1};
  for (std::size_t i = 0; i < e.properties.size(); ++i)
    for (int a = 0; a < 3; ++a)
      if (!e.properties[i].count && e.properties[i].name == std::string(1, static_cast<char>('x' + a)))
        axis_of[a] = static_cast<int>(i);
  if (axis_of[0] < 0 || axis_of[1] < 0 || axis_of[2] < 0) fail_input("{}: its vertices lack x, y or z", name);
  content.vertices.resize(e.count);
  std::vector<double> row(e.properties.size());
  for (std::uint64_t v = 0; v < e.count; ++v) {
    for (std::size_t i = 0; i < e.properties.size(); ++i) {
      const Property& p = e.properties[i];
      if (!p.count) {
        row[i] = in.number(p.type, "vertex", v);
        continue;
      }
      for (std::uint64_t n = in.list_length(*p.count, p.type, "vertex", v); n > 0; --n) in.number(p.type, "vertex", v);
    }
    const Vec3d point{row[std::size_t(axis_of[0])], row[std::size_t(axis_of[1])], row[std::size_t(axis_of[2])]};
    if (!is_finite(point))
      fail_input("{}: vertex {} is ({}, {}, {}), not a finite place", name, v, point.x, point.y, point.z);
    content.vertices[v] = point;
  }
}

void read_faces(Reader& in, const Element& e, const std::string& name, PlyContent& content) {
  content.triangles.reserve(e.count);
  std::vector<std::uint32_t> polygon;
  for (std::uint64_t f = 0; f < e.count; ++f)
    for (const Property& p : e.properties) {
      if (!p.count) {
        in.number(p.type, "face", f);
        continue;
      }
      const bool indices = p.name == "vertex_indices" || p.name == "vertex_index";
      polygon.clear();
      for (std::uint64_t n = in.list_length(*p.count, p.type, "face", f); n > 0; --n) {
        const double index = in.number(p.type, "face", f);
        if (!indices) continue;
        if (!(index >= 0) || index >= double(content.vertices.size()) || index != std::floor(index))
          fail_input("{}: face {} names vertex {}, but there are {} (0 to {})", name, f, index, content.vertices.size(),
                     double(content.vertices.size()) - 1);
        polygon.push_back(static_cast<std::uint32_t>(index));
      }
      for (std::size_t k = 2; k < polygon.size(); ++k)
        content.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
}

}  // namespace

PlyContent parse_ply(std::string_view text, const std::string& name, bool faces) {
  Reader in(text, name);
  const Header header = in.header();
  PlyContent content;
  bool vertices = false;
  for (const Element& e : header.elements) {
    in.check_room(e);
    if (e.name == "vertex") {
      vertices = true;
      if (e.count > 0xffffffffu) fail_input("{}: {} vertices are more than can be counted here", name, e.count);
      read_vertices(in, e, name, content);
    } else if (e.name == "face" && faces) {
      if (!vertices) fail_input("{}: its faces come before its vertices", name);
      read_faces(in, e, name, content);
    } else {
      for (std::uint64_t i = 0; i < (e.properties.empty() ? 0 : e.count); ++i)
        for (const Property& p : e.properties)
          for (std::uint64_t n = p.count ? in.list_length(*p.count, p.type, e.name.c_str(), i) : 1; n > 0; --n)
            in.number(p.type, e.name.c_str(), i);
    }
  }
  if (!vertices) fail_input("{}: has no element \"vertex\"", name);
  return content;
}

}  // namespace dreampm
