#include "dreampm/import/gltf.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "dreampm/base/base64.h"
#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/uri.h"
#include "dreampm/import/gltf_json.h"
#include "dreampm/import/raw_numbers.h"

namespace dreampm {
namespace {

/// The place of a node: its axes and its origin.
struct Place {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};

  Vec3d turn(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d operator()(const Vec3d& v) const { return turn(v) + origin; }
  /// Returns the place of a node within this one.
  Place operator()(const Place& b) const { return {turn(b.x), turn(b.y), turn(b.z), (*this)(b.origin)}; }
  bool mirrors() const { return dot(x, cross(y, z)) < 0; }
};

Place place_of(const GltfValue& node) {
  if (node.has("matrix")) {
    const auto m = node.numbers("matrix", std::vector<double>(16));
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  }
  const auto t = node.numbers("translation", {0, 0, 0}), s = node.numbers("scale", {1, 1, 1}),
             q = node.numbers("rotation", {0, 0, 0, 1});
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)} * s[0],
          Vec3d{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)} * s[1],
          Vec3d{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)} * s[2],
          {t[0], t[1], t[2]}};
}

/// Returns the type of the numbers of an accessor.
const NumberType* number_type_of(std::size_t component) {
  switch (component) {
    case 5121:
      return find_number_type("UInt8");
    case 5123:
      return find_number_type("UInt16");
    case 5125:
      return find_number_type("UInt32");
    case 5126:
      return find_number_type("Float32");
  }
  return nullptr;
}

class Reader {
 public:
  Reader(const GltfParts& parts, const std::string& name, const std::filesystem::path& folder)
      : file_(parts.json, name), bytes_(parts.bytes), name_(name), folder_(folder) {}

  Model read() {
    const bool scenes = has_some("scenes"), nodes = has_some("nodes");
    if (scenes) {
      const GltfValue scene = file_.at("scenes").at(file_.count("scene", 0));
      if (scene.has("nodes")) add_nodes(indices_of(scene.at("nodes")));
    } else if (nodes) {
      add_nodes(roots());
    } else if (has_some("meshes")) {
      for (std::size_t m = 0; m < file_.at("meshes").size(); ++m) add_mesh(m, {});
    }
    join_corners(model_);
    return std::move(model_);
  }

 private:
  bool has_some(const char* key) const { return file_.has(key) && file_.at(key).size() > 0; }
  static std::vector<std::size_t> indices_of(const GltfValue& list) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < list.size(); ++i) out.push_back(list.at(i).as_count());
    return out;
  }
  /// Nodes that are in no other.
  std::vector<std::size_t> roots() const {
    const GltfValue nodes = file_.at("nodes");
    std::vector<bool> inner(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (nodes.at(n).has("children"))
        for (const std::size_t child : indices_of(nodes.at(n).at("children")))
          if (child < inner.size()) inner[child] = true;
    std::vector<std::size_t> out;
    for (std::size_t n = 0; n < inner.size(); ++n)
      if (!inner[n]) out.push_back(n);
    return out;
  }
  void add_nodes(const std::vector<std::size_t>& first) {
    const GltfValue nodes = file_.at("nodes");
    std::vector<bool> seen(nodes.size());
    std::vector<std::pair<std::size_t, Place>> open;
    for (auto n = first.rbegin(); n != first.rend(); ++n) open.emplace_back(*n, Place{});
    while (!open.empty()) {
      const auto [n, outer] = open.back();
      open.pop_back();
      const GltfValue node = nodes.at(n);
      if (seen[n]) node.refuse("stands in two places, or within itself");
      seen[n] = true;
      const Place place = outer(place_of(node));
      if (node.has("mesh")) add_mesh(node.count("mesh"), place);
      if (!node.has("children")) continue;
      const std::vector<std::size_t> children = indices_of(node.at("children"));
      for (auto child = children.rbegin(); child != children.rend(); ++child) open.emplace_back(*child, place);
    }
  }
  void add_mesh(std::size_t mesh, const Place& place) {
    const GltfValue parts = file_.at("meshes").at(mesh).at("primitives");
    for (std::size_t p = 0; p < parts.size(); ++p) add_part(parts.at(p), place);
  }
  void add_part(const GltfValue& part, const Place& place) {
    enum Mode : std::size_t { lines_end = 3, triangles = 4, strip = 5, fan = 6 };
    const std::size_t mode = part.count("mode", triangles);
    if (mode > fan) part.refuse(fmt::format("its mode is {}, the last one is {}", mode, std::size_t(fan)));
    if (mode <= lines_end || !part.at("attributes").has("POSITION")) return;
    const std::size_t before = model_.vertices.size();
    const std::vector<double> x = values(part.at("attributes").count("POSITION"), "VEC3", 3);
    for (std::size_t i = 0; i < x.size(); i += 3) model_.vertices.push_back(place(Vec3d{x[i], x[i + 1], x[i + 2]}));
    const std::size_t count = model_.vertices.size() - before;
    std::vector<double> corners;
    if (part.has("indices"))
      corners = values(part.count("indices"), "SCALAR", 1);
    else
      for (std::size_t i = 0; i < count; ++i) corners.push_back(static_cast<double>(i));
    const std::size_t n = mode == triangles ? corners.size() / 3 : corners.size() < 3 ? 0 : corners.size() - 2;
    std::size_t wrong = 0;
    for (std::size_t t = 0; t < n; ++t) {
      std::array<std::size_t, 3> at{3 * t, 3 * t + 1, 3 * t + 2};
      if (mode == strip) at = {t, t + 1, t + 2};
      if (mode == fan) at = {0, t + 1, t + 2};
      if (place.mirrors() != (mode == strip && t % 2 == 1)) std::swap(at[1], at[2]);
      std::array<std::uint32_t, 3> triangle;
      bool there = true;
      for (std::size_t k = 0; k < 3; ++k) {
        there = there && corners[at[k]] >= 0 && corners[at[k]] < static_cast<double>(count);
        if (there) triangle[k] = static_cast<std::uint32_t>(before + static_cast<std::size_t>(corners[at[k]]));
      }
      wrong += !there;
      if (there) model_.triangles.push_back(triangle);
    }
    if (wrong > 0) fail_input("{}: {} of {} triangles name vertices that are not there", name_, wrong, n);
  }

  /// The numbers of an accessor, `columns` a row. Positions are floats, and indices whole numbers.
  std::vector<double> values(std::size_t index, const char* type, std::size_t columns) {
    const GltfValue accessor = file_.at("accessors").at(index);
    if (const std::string its = accessor.text("type"); its != type)
      accessor.refuse(fmt::format("is of type {:.20}, {} is wanted", its, type));
    const std::size_t component = accessor.count("componentType"), rows = accessor.count("count");
    const NumberType* const number = number_type_of(component);
    const bool is_float = component == 5126;
    if (!number || is_float != (columns == 3))
      accessor.refuse(fmt::format("its componentType {} is not read here", component));
    std::vector<double> out;
    if (accessor.has("bufferView"))
      out = take(accessor, rows, columns, *number);
    else if (!accessor.has("sparse"))
      accessor.refuse("lacks bufferView");
    if (accessor.has("sparse")) replace(accessor, out, rows, columns, *number);
    return out;
  }
  /// Rows that a view holds from an offset on.
  std::vector<double> take(const GltfValue& of, std::size_t rows, std::size_t columns, const NumberType& number) {
    const GltfValue view = file_.at("bufferViews").at(of.count("bufferView"));
    const std::string_view bytes = buffer(view.count("buffer"));
    const std::size_t begin = view.count("byteOffset", 0), length = view.count("byteLength"),
                      offset = of.count("byteOffset", 0), row = columns * number.bytes,
                      stride = view.count("byteStride", row);
    if (begin > bytes.size() || length > bytes.size() - begin)
      view.refuse(fmt::format("goes beyond the {} bytes of its buffer", bytes.size()));
    if (rows == 0) return {};
    if (stride < row) view.refuse(fmt::format("its byteStride is {}, and a row has {} bytes", stride, row));
    if (offset > length || row > length - offset || rows - 1 > (length - offset - row) / stride)
      of.refuse(fmt::format("has {} rows, which {} bytes do not hold", rows, length));
    std::vector<double> out;
    out.reserve(rows * columns);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c)
        out.push_back(number.read(bytes.data() + begin + offset + r * stride + c * number.bytes, false));
    return out;
  }
  /// A few rows are given anew, in a file that may leave out those that are zero.
  void replace(const GltfValue& accessor, std::vector<double>& out, std::size_t rows, std::size_t columns,
               const NumberType& number) {
    const GltfValue sparse = accessor.at("sparse");
    const std::size_t count = sparse.count("count");
    const NumberType* const index = number_type_of(sparse.at("indices").count("componentType"));
    if (!index) sparse.refuse("its indices are of a componentType that is not read");
    const std::vector<double> at = take(sparse.at("indices"), count, 1, *index),
                              with = take(sparse.at("values"), count, columns, number);
    if (out.empty()) {
      constexpr std::size_t most = 1000;  // times as many zeros as there are others: no more memory than files ask for
      if (rows / most > count) accessor.refuse(fmt::format("has {} rows, {} of which are given", rows, count));
      out.resize(rows * columns);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!(at[i] >= 0 && at[i] < static_cast<double>(rows)))
        sparse.refuse(fmt::format("names row {}, and there are {}", at[i], rows));
      for (std::size_t c = 0; c < columns; ++c)
        out[static_cast<std::size_t>(at[i]) * columns + c] = with[i * columns + c];
    }
  }

  /// The bytes of a buffer: those that follow in a .glb file, of a data URI, or of a file.
  std::string_view buffer(std::size_t index) {
    if (const auto known = buffers_.find(index); known != buffers_.end()) return known->second;
    const GltfValue of = file_.at("buffers").at(index);
    const std::size_t length = of.count("byteLength");
    std::string_view bytes;
    if (!of.has("uri")) {
      if (!bytes_ || index != 0) of.refuse("has no uri, and no bytes follow");
      bytes = *bytes_;
    } else {
      bytes = read_.emplace(index, of_uri(of, of.text("uri"))).first->second;
    }
    if (length > bytes.size()) of.refuse(fmt::format("its byteLength is {}, and it has {}", length, bytes.size()));
    return buffers_[index] = bytes.substr(0, length);
  }
  std::string of_uri(const GltfValue& of, const std::string& uri) const {
    if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(',');
      if (comma == uri.npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
        of.refuse("its data URI is not in base64");
      return base64_decoded(std::string_view(uri).substr(comma + 1));
    }
    const std::filesystem::path as_written = folder_ / uri;
    const auto path = std::filesystem::is_regular_file(as_written) ? as_written : folder_ / percent_decoded(uri);
    if (!std::filesystem::is_regular_file(path)) of.refuse(fmt::format("its file {} is not there", path.string()));
    return read_file(path);
  }

  GltfValue file_;
  std::optional<std::string_view> bytes_;
  const std::string& name_;
  const std::filesystem::path& folder_;
  std::map<std::size_t, std::string> read_;
  std::map<std::size_t, std::string_view> buffers_;
  Model model_;
};

}  // namespace

Model parse_gltf(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
  const GltfParts parts = gltf_parts(text, name);
  check_gltf_extensions(parts.json, name);
  return Reader(parts, name, folder).read();
}

}  // namespace dreampm
