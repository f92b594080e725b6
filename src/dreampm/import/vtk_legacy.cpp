// The layout is that of "VTK File Formats", section "Simple Legacy Formats"
// (https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html).
#include "dreampm/import/vtk_legacy.h"

#include <charconv>
#include <map>
#include <tuple>

#include "dreampm/base/error.h"
#include "dreampm/geometry/whole.h"
#include "dreampm/import/point_arrays.h"
#include "dreampm/import/raw_numbers.h"
#include "dreampm/import/text_lines.h"
#include "dreampm/import/vtk_cells.h"

namespace dreampm {
namespace {

class LegacyFile {
 public:
  LegacyFile(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Model read() {
    read_head();
    for (std::string word = next_word(); !word.empty(); word = next_word()) {
      const auto known = sections().find(lower(word));
      if (known == sections().end()) fail_input("{}: has a section \"{}\", which is not known", name_, shown(word));
      (this->*known->second)(lower(word));
    }
    if (model_.vertices.empty()) fail_input("{}: holds no points", name_);
    require_finite(model_, name_);
    add_vtk_cells(model_, cells_, name_);
    for (const PointArray& a : arrays_) take_point_array(model_, a, name_);
    return std::move(model_);
  }

 private:
  using Section = void (LegacyFile::*)(const std::string& word);
  static const std::map<std::string, Section>& sections() {
    static const std::map<std::string, Section> all{{"dataset", &LegacyFile::dataset},
                                                    {"points", &LegacyFile::points},
                                                    {"vertices", &LegacyFile::cells},
                                                    {"lines", &LegacyFile::cells},
                                                    {"polygons", &LegacyFile::cells},
                                                    {"triangle_strips", &LegacyFile::cells},
                                                    {"cells", &LegacyFile::cells},
                                                    {"cell_types", &LegacyFile::cell_types},
                                                    {"point_data", &LegacyFile::data_of},
                                                    {"cell_data", &LegacyFile::data_of},
                                                    {"scalars", &LegacyFile::scalars},
                                                    {"lookup_table", &LegacyFile::lookup_table},
                                                    {"color_scalars", &LegacyFile::colors},
                                                    {"vectors", &LegacyFile::vectors},
                                                    {"normals", &LegacyFile::vectors},
                                                    {"tensors", &LegacyFile::vectors},
                                                    {"global_ids", &LegacyFile::vectors},
                                                    {"pedigree_ids", &LegacyFile::vectors},
                                                    {"texture_coordinates", &LegacyFile::texture},
                                                    {"field", &LegacyFile::field},
                                                    {"metadata", &LegacyFile::metadata}};
    return all;
  }

  static std::string shown(std::string_view word) {
    std::string out;
    for (const char c : word.substr(0, 30)) out += c >= ' ' && c <= '~' ? c : '?';
    return out;
  }
  std::string_view next_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  static bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  std::string next_word() {
    while (at_ < text_.size() && blank(text_[at_])) ++at_;
    const std::size_t first = at_;
    while (at_ < text_.size() && !blank(text_[at_])) ++at_;
    return std::string(text_.substr(first, at_ - first));
  }
  std::string need_word(const char* what) {
    std::string word = next_word();
    if (word.empty()) fail_input("{}: is cut short: it ends before {}", name_, what);
    return word;
  }
  std::size_t need_count(const char* what) {
    const std::string word = need_word(what);
    std::size_t n = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), n);
    if (error != std::errc() || end != word.data() + word.size())
      fail_input("{}: {} is \"{}\": a whole number is wanted", name_, what, shown(word));
    if (n > text_.size()) fail_input("{}: names {} {}, which its {} bytes do not hold", name_, n, what, text_.size());
    return n;
  }
  const NumberType& need_type() {
    static const std::map<std::string, const char*> names{
        {"unsigned_char", "UInt8"}, {"char", "Int8"},         {"unsigned_short", "UInt16"}, {"short", "Int16"},
        {"unsigned_int", "UInt32"}, {"int", "Int32"},         {"unsigned_long", "UInt64"},  {"long", "Int64"},
        {"float", "Float32"},       {"double", "Float64"},    {"vtkidtype", "Int32"},       {"vtktypeint64", "Int64"},
        {"vtktypeuint8", "UInt8"},  {"vtktypeint32", "Int32"}};
    const std::string word = lower(need_word("a type"));
    const auto found = names.find(word);
    if (found == names.end()) fail_input("{}: numbers of type \"{}\" are not read", name_, shown(word));
    return *find_number_type(found->second);
  }
  std::vector<double> values(std::size_t n, const NumberType& type, const char* what) {
    std::vector<double> out;
    const std::size_t left = text_.size() - at_, least = binary_ ? type.bytes : 1;
    if (n > left / least) fail_input("{}: is cut short: {} wants {} numbers", name_, what, n);
    out.reserve(n);
    if (!binary_) {
      for (std::size_t i = 0; i < n; ++i) out.push_back(number(need_word(what), what));
      return out;
    }
    next_line();  // what is left of the line before
    if (n * type.bytes > text_.size() - at_) fail_input("{}: is cut short: {} wants {} numbers", name_, what, n);
    for (std::size_t i = 0; i < n; ++i) out.push_back(type.read(&text_[at_ + i * type.bytes], true));
    at_ += n * type.bytes;
    return out;
  }
  double number(const std::string& word, const char* what) const {
    double v = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
    if (error == std::errc::result_out_of_range) return 0;
    if (error != std::errc() || end != word.data() + word.size())
      fail_input("{}: {} holds \"{}\", which is no number", name_, what, shown(word));
    return v;
  }

  void read_head() {
    constexpr std::string_view magic = "# vtk DataFile Version ";
    const std::string_view first = next_line();
    if (!first.starts_with(magic)) fail_input("{}: does not begin with \"{}\"", name_, magic);
    const std::string_view rest = first.substr(magic.size());
    version_ = number(std::string(rest.substr(0, rest.find(' '))), "version");
    next_line();  // a title
    const std::string kind = lower(need_word("ASCII or BINARY"));
    if (kind != "ascii" && kind != "binary") fail_input("{}: is \"{}\": ASCII or BINARY is wanted", name_, shown(kind));
    binary_ = kind == "binary";
  }
  void dataset(const std::string&) {
    const std::string kind = lower(need_word("the kind of data set"));
    if (kind != "polydata" && kind != "unstructured_grid")
      fail_input("{}: its data set is {}; POLYDATA and UNSTRUCTURED_GRID are read", name_, shown(kind));
  }
  void points(const std::string&) {
    const std::size_t n = need_count("points");
    const NumberType& type = need_type();
    const std::vector<double> v = values(3 * n, type, "POINTS");
    for (std::size_t i = 0; i < n; ++i) model_.vertices.push_back({v[3 * i], v[3 * i + 1], v[3 * i + 2]});
  }
  /// Cells as versions before 5 have them: for each its number of points, then these.
  void take_counted(const std::vector<double>& list, VtkCells& out) const {
    out.offsets = {0};
    for (auto at = list.begin(); at != list.end();) {
      const std::optional<std::size_t> points = whole<std::size_t>(*at);
      const auto left = static_cast<std::size_t>(list.end() - at) - 1;
      if (!points || *points > left)
        fail_input("{}: cell {} of its {} has {} points, but {} numbers follow", name_, out.offsets.size() - 1,
                   out.kind, *at, left);
      const auto end = at + 1 + static_cast<std::ptrdiff_t>(*points);
      out.connectivity.insert(out.connectivity.end(), at + 1, end);
      out.offsets.push_back(static_cast<double>(out.connectivity.size()));
      at = end;
    }
  }
  void cells(const std::string& kind) {
    const std::size_t a = need_count("cells"), b = need_count("numbers of cells");
    VtkCells& out = cells_.emplace_back();
    out.kind = kind;
    if (version_ < 5) {
      take_counted(values(b, *find_number_type("Int32"), "cells"), out);
      if (out.offsets.size() - 1 != a)
        fail_input("{}: its {} are {}, but its list of them holds {}", name_, kind, a, out.offsets.size() - 1);
      return;
    }
    for (const auto& [what, count, list] :
         {std::tuple("offsets", a, &out.offsets), std::tuple("connectivity", b, &out.connectivity)}) {
      if (lower(need_word(what)) != what) fail_input("{}: its {} lack {}", name_, kind, what);
      const NumberType& type = need_type();
      *list = values(count, type, what);
    }
  }
  void cell_types(const std::string&) {
    const std::size_t n = need_count("types of cells");
    if (cells_.empty()) fail_input("{}: its CELL_TYPES come before its CELLS", name_);
    cells_.back().types = values(n, *find_number_type("Int32"), "CELL_TYPES");
  }
  void data_of(const std::string& word) {
    of_points_ = word == "point_data";
    rows_ = need_count("rows of data");
  }
  void keep(PointArray array) {
    if (of_points_) arrays_.push_back(std::move(array));
  }
  void scalars(const std::string&) {
    const std::string name = need_word("a name");
    const NumberType& type = need_type();
    // The number of columns may be left out.
    const std::string_view rest = text_.substr(at_, text_.find('\n', at_) - at_);
    std::size_t columns = 1;
    if (rest.find_first_not_of(" \t\r") != rest.npos) columns = need_count("columns");
    if (const std::size_t before = at_; lower(next_word()) == "lookup_table")
      need_word("a name");
    else
      at_ = before;
    keep({name, columns, values(rows_ * columns, type, "SCALARS"), type.bytes == 1});
  }
  void lookup_table(const std::string&) {
    need_word("a name");
    const std::size_t n = need_count("colors");
    values(4 * n, *find_number_type(binary_ ? "UInt8" : "Float32"), "LOOKUP_TABLE");
  }
  void colors(const std::string&) {
    const std::string name = need_word("a name");
    const std::size_t columns = need_count("columns");
    keep({"color", columns, values(rows_ * columns, *find_number_type(binary_ ? "UInt8" : "Float32"), "COLOR_SCALARS"),
          binary_});
  }
  void vectors(const std::string& word) {
    const std::string name = need_word("a name");
    const NumberType& type = need_type();
    const std::size_t columns = word == "tensors" ? 9 : word.ends_with("_ids") ? 1 : 3;
    const bool ids = word.ends_with("_ids");
    keep({ids ? "id" : name, columns, values(rows_ * columns, type, "an array")});
  }
  void texture(const std::string&) {
    need_word("a name");
    const std::size_t columns = need_count("columns");
    const NumberType& type = need_type();
    values(rows_ * columns, type, "TEXTURE_COORDINATES");
  }
  /// Reads a field: before POINT_DATA it is of the whole data set.
  void field(const std::string&) {
    need_word("a name");
    for (std::size_t n = need_count("arrays"); n > 0; --n) {
      std::string name = need_word("a name");
      if (lower(name) == "metadata") metadata(""), name = need_word("a name");
      const std::size_t columns = need_count("columns"), rows = need_count("rows");
      if (columns != 0 && rows > text_.size() / columns)
        fail_input("{}: its array {} has {} rows of {}, which its {} bytes do not hold", name_, shown(name), rows,
                   columns, text_.size());
      if (pass_over_bits_or_texts(rows * columns)) continue;
      const NumberType& type = need_type();
      keep({name, columns, values(rows * columns, type, "FIELD"), type.bytes == 1});
    }
  }
  /// Skips the bytes of an array that is not used.
  void pass_over(std::size_t bytes) {
    if (bytes > text_.size() - at_) fail_input("{}: is cut short: it ends in an array of bits or texts", name_);
    at_ += bytes;
  }
  /// False for arrays of other types, whose type is not read then.
  bool pass_over_bits_or_texts(std::size_t n) {
    const std::size_t before = at_;
    const std::string type = lower(next_word());
    const bool bits = type == "bit", texts = type == "string" || type == "utf8_string";
    if (!bits && !texts) return at_ = before, false;
    if (bits && !binary_) return values(n, *find_number_type("UInt8"), "FIELD"), true;
    next_line();
    if (bits) return pass_over((n + 7) / 8), true;
    for (; n > 0; --n) {
      if (binary_ || at_ == text_.size())
        pass_over(text_length());
      else
        next_line();  // of ASCII each text is a line
    }
    return true;
  }
  /// The length of a binary text stands before it: in its first two bits how many bytes it takes.
  std::size_t text_length() {
    if (at_ == text_.size()) pass_over(1);
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text_[at_ + i]); };
    const std::size_t bytes = std::size_t(1) << (3 - (byte(0) >> 6));
    if (bytes > text_.size() - at_) pass_over(bytes);
    std::size_t length = byte(0) & 0x3f;
    for (std::size_t i = 1; i < bytes; ++i) length = length << 8 | byte(i);
    at_ += bytes;
    return length;
  }
  /// Up to an empty line.
  void metadata(const std::string&) {
    next_line();
    while (at_ < text_.size() && next_line().find_first_not_of(" \t") != std::string_view::npos) {
    }
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0, rows_ = 0;
  double version_ = 0;
  bool binary_ = false, of_points_ = false;
  Model model_;
  std::vector<VtkCells> cells_;
  std::vector<PointArray> arrays_;
};

}  // namespace

Model parse_vtk(std::string_view text, const std::string& name) { return LegacyFile(text, name).read(); }

}  // namespace dreampm
