// The layout is that of "VTKHDF File Format"
// (https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html).
#include "dreampm/geometry/vtkhdf.h"

#include <numeric>

#include "dreampm/base/error.h"
#include "dreampm/base/hdf5_handle.h"
#include "dreampm/geometry/point_arrays.h"

namespace dreampm {
namespace {

hid_t open_bytes(std::string_view bytes, const std::string& name) {
  const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, std::size_t(1) << 20, false);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size());  // which HDF5 copies
  // HDF5 refuses an image in memory under the name of a file that is there.
  const hid_t file = H5Fopen((name + " in memory").c_str(), H5F_ACC_RDONLY, access);
  if (file < 0) fail_input("{}: is no HDF5 file, or is damaged", name);
  return file;
}

/// An array of numbers.
class Array {
 public:
  Array(hid_t group, const std::string& path, const std::string& file)
      : file_(file), path_(path), data_(open(group, path), H5Dclose) {
    if (!data_.ok()) return;
    const H5Handle space(H5Dget_space(data_), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 1 || rank > 2) fail_input("{}: its array {} has {} axes; 1 or 2 are read", file, path, rank);
    H5Sget_simple_extent_dims(space, size_, nullptr);
    if (rank == 1) size_[1] = 1;
    rank_ = rank;
  }
  bool there() const { return data_.ok(); }
  std::size_t rows() const { return size_[0]; }
  std::size_t columns() const { return size_[1]; }
  bool bytes() const {
    const H5Handle type(H5Dget_type(data_), H5Tclose);
    return H5Tget_size(type) == 1;
  }
  std::vector<double> read(std::size_t first, std::size_t rows) const {
    if (first > size_[0] || rows > size_[0] - first)
      fail_input("{}: its array {} has {} rows; {} from row {} on are asked for", file_, path_, size_[0], rows, first);
    std::vector<double> out(rows * columns());
    if (out.empty()) return out;
    const hsize_t start[2]{first, 0}, count[2]{rows, size_[1]};
    const H5Handle space(H5Dget_space(data_), H5Sclose), memory(H5Screate_simple(rank_, count, nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr) < 0 ||
        H5Dread(data_, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, out.data()) < 0)
      fail_input("{}: its array {} cannot be read as numbers", file_, path_);
    return out;
  }

 private:
  static hid_t open(hid_t group, const std::string& path) {
    // Each part of the path is asked for: HDF5 takes the lack of a group as an error.
    for (std::size_t at = path.find('/'); at != path.npos; at = path.find('/', at + 1))
      if (H5Lexists(group, path.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return -1;
    return H5Lexists(group, path.c_str(), H5P_DEFAULT) > 0 ? H5Dopen2(group, path.c_str(), H5P_DEFAULT) : -1;
  }
  const std::string& file_;
  std::string path_;
  H5Handle data_;
  int rank_ = 1;
  hsize_t size_[2]{0, 1};
};

herr_t take_name(hid_t, const char* name, const H5L_info_t*, void* out) {
  static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name)
      : name_(name), file_(open_bytes(bytes, name), H5Fclose), root_(open_root(), H5Gclose) {
    check_type();
  }

  Model read() {
    const std::size_t steps = array("Steps/Values").rows();
    const std::size_t part = first_of("Steps/PartOffsets"), first = first_of("Steps/PointOffsets");
    const Array counts = need("NumberOfPoints");
    const Array of_step = array("Steps/NumberOfParts");
    const std::size_t parts = of_step.there() ? first_of("Steps/NumberOfParts") : steps > 0 ? 1 : counts.rows();
    for (const char* cells : {"Polygons", "Strips"})
      if (sum(array(std::string(cells) + "/NumberOfCells"), part, parts) > 0)
        fail_input("{}: holds {}; of VTKHDF only points are read, save it as .vtp", name_, cells);
    const std::size_t points = sum(counts, part, parts);
    if (points == 0) fail_input("{}: holds no points", name_);
    const std::vector<double> x = need("Points").read(first, points);
    if (x.size() != 3 * points) fail_input("{}: its points have {} coordinates", name_, x.size() / points);
    Model model;
    for (std::size_t i = 0; i < points; ++i) model.vertices.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
    require_finite(model, name_);
    for (const std::string& name : names("PointData")) {
      const Array values = need("PointData/" + name);
      const Array offsets = array("Steps/PointDataOffsets/" + name);
      const std::size_t at = offsets.there() ? first_of("Steps/PointDataOffsets/" + name) : first;
      take_point_array(model, {name, values.columns(), values.read(at, points), values.bytes()}, name_);
    }
    if (steps > 1) model.warnings.push_back(fmt::format("{}: has {} steps; the first is taken", name_, steps));
    return model;
  }

 private:
  hid_t open_root() const {
    const hid_t root = H5Lexists(file_, "VTKHDF", H5P_DEFAULT) > 0 ? H5Gopen2(file_, "VTKHDF", H5P_DEFAULT) : -1;
    if (root < 0) fail_input("{}: is an HDF5 file without a group VTKHDF", name_);
    return root;
  }
  void check_type() const {
    const H5Handle attribute(H5Aexists(root_, "Type") > 0 ? H5Aopen(root_, "Type", H5P_DEFAULT) : -1, H5Aclose);
    const H5Handle type(attribute.ok() ? H5Aget_type(attribute) : -1, H5Tclose);
    std::string text;
    if (type.ok() && H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0) {
      text.resize(std::min<std::size_t>(H5Tget_size(type), 64));
      if (text.size() != H5Tget_size(type) || H5Aread(attribute, type, text.data()) < 0) text.clear();
    }
    if (!text.starts_with("PolyData") && !text.starts_with("UnstructuredGrid"))
      fail_input("{}: is not of Type PolyData or UnstructuredGrid, which are read", name_);
  }
  Array array(const std::string& path) const { return Array(root_, path, name_); }
  Array need(const std::string& path) const {
    if (!array(path).there()) fail_input("{}: lacks {}", name_, path);
    return array(path);
  }
  /// The first number; 0 without the array.
  std::size_t first_of(const std::string& path) const {
    const Array a = array(path);
    return a.there() && a.rows() > 0 ? static_cast<std::size_t>(std::max(0.0, a.read(0, 1)[0])) : 0;
  }
  static std::size_t sum(const Array& counts, std::size_t first, std::size_t parts) {
    if (!counts.there()) return 0;
    const std::vector<double> n = counts.read(first, parts);
    return static_cast<std::size_t>(std::max(0.0, std::accumulate(n.begin(), n.end(), 0.0)));
  }
  std::vector<std::string> names(const char* group) const {
    std::vector<std::string> out;
    if (H5Lexists(root_, group, H5P_DEFAULT) <= 0) return out;
    const H5Handle of(H5Gopen2(root_, group, H5P_DEFAULT), H5Gclose);
    hsize_t at = 0;
    if (of.ok()) H5Literate(of, H5_INDEX_NAME, H5_ITER_INC, &at, take_name, &out);
    return out;
  }

  const std::string& name_;
  H5Handle file_, root_;
};

}  // namespace

Model parse_vtkhdf(std::string_view bytes, const std::string& name) {
  const QuietHdf5 quiet;
  return Reader(bytes, name).read();
}

}  // namespace dreampm
