// The layout is that of SideFX's page "Geometry file formats, old .bgeo": big-endian throughout.
#include "dreampm/import/bgeo.h"

#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/import/point_arrays.h"
#include "dreampm/import/raw_numbers.h"

namespace dreampm {
namespace {

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  std::string_view take(std::size_t bytes) {
    if (bytes > text_.size() - at_) fail_input("{}: is cut short: {} bytes, and it goes on", name_, text_.size());
    at_ += bytes;
    return text_.substr(at_ - bytes, bytes);
  }
  template <class T>
  double number() {
    return read_raw<T>(take(sizeof(T)).data(), true);
  }
  /// A number of things, each of which takes `bytes` bytes or more of the rest.
  std::size_t count(const char* what, std::size_t bytes) {
    const double n = number<std::int32_t>();
    if (n < 0 || n * static_cast<double>(bytes) > static_cast<double>(text_.size() - at_))
      fail_input("{}: names {} {}, which its {} bytes do not hold", name_, n, what, text_.size());
    return static_cast<std::size_t>(n);
  }
  std::string text() { return std::string(take(static_cast<std::size_t>(number<std::uint16_t>()))); }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// An attribute of the points.
struct Attribute {
  std::string name;
  std::size_t size;
  bool whole;  ///< 4-byte integers, else floats
};

Attribute read_attribute(Reader& in, const std::string& file) {
  enum Type { number = 0, integer = 1, index = 4, vector = 5 };
  Attribute a{in.text(), static_cast<std::size_t>(in.number<std::uint16_t>()), false};
  const auto type = static_cast<int>(in.number<std::int32_t>());
  if (type == index) {
    for (std::size_t n = in.count("strings", 2); n > 0; --n) in.text();
    return {a.name, a.size, true};
  }
  if (type != number && type != integer && type != vector)
    fail_input("{}: its attribute {} is of type {}, which is not read; numbers, vectors and indices are", file, a.name,
               type);
  in.take(4 * a.size);  // the default
  a.whole = type == integer;
  return a;
}

void check_kind(std::string_view text, const std::string& file) {
  if (text.starts_with("BgeoV")) return;
  if (text.starts_with("\x7fNSJb") || text.starts_with("[") || text.starts_with("\x7f"))
    fail_input("{}: is a .bgeo of JSON, as Houdini writes since version 12; save it as .bhclassic, .vtk or .ply", file);
  fail_input("{}: does not begin as a .bgeo does; the classic one of version 5 is read", file);
}

}  // namespace

Model parse_bgeo(std::string_view text, const std::string& name) {
  check_kind(text, name);
  Reader in(text, name);
  in.take(5);
  if (const double version = in.number<std::int32_t>(); version != 5)
    fail_input("{}: is of version {}; 5 is read", name, version);
  const std::size_t points = in.count("points", 16);
  in.take(4 * 3);  // primitives, groups of points and of primitives
  const std::size_t attributes = in.count("attributes of points", 8);
  in.take(4 * 3);  // attributes of vertices, primitives and the whole
  std::vector<Attribute> described;
  std::vector<PointArray> arrays;
  for (std::size_t a = 0; a < attributes; ++a) {
    described.push_back(read_attribute(in, name));
    if (described.back().size == 0) {  // a look at each for every point would take long
      described.pop_back();
      continue;
    }
    arrays.push_back({described.back().name, described.back().size, {}});
  }
  Model model;
  model.vertices.reserve(points);
  for (std::size_t p = 0; p < points; ++p) {
    const double x = in.number<float>(), y = in.number<float>(), z = in.number<float>(), w = in.number<float>();
    if (!(w != 0) || !std::isfinite(w)) fail_input("{}: point {} has the weight {}", name, p, w);
    model.vertices.push_back({x / w, y / w, z / w});
    for (std::size_t a = 0; a < arrays.size(); ++a)
      for (std::size_t k = 0; k < described[a].size; ++k)
        arrays[a].values.push_back(described[a].whole ? in.number<std::int32_t>() : in.number<float>());
  }
  require_finite(model, name);
  for (const PointArray& a : arrays) take_point_array(model, a, name);
  return model;
}

}  // namespace dreampm
