// The layout is that of "VTKHDF File Format"
// (https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html).
#include "dreampm/import/vtkhdf.h"

#include <algorithm>
#include <optional>

#include "dreampm/base/error.h"
#include "dreampm/base/hdf5_handle.h"
#include "dreampm/geometry/whole.h"
#include "dreampm/import/point_arrays.h"
#include "dreampm/import/vtk_cells.h"

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

/// True if an object has a link of that name.
bool has_link(hid_t object, const std::string& name, const std::string& file) {
  const htri_t there = H5Lexists(object, name.c_str(), H5P_DEFAULT);
  if (there < 0) fail_input("{}: is damaged: HDF5 cannot look for {} in it", file, name);
  return there > 0;
}

/// An array of numbers in a file of `file_bytes` bytes.
class Array {
 public:
  Array(hid_t group, const std::string& path, const std::string& file, std::size_t file_bytes)
      : file_(file), path_(path), file_bytes_(file_bytes), data_(open(group, path), H5Dclose) {
    if (!data_.ok()) return;
    const H5Handle space(H5Dget_space(data_), H5Sclose);
    rank_ = H5Sget_simple_extent_ndims(space);
    if (rank_ == 1 || rank_ == 2) H5Sget_simple_extent_dims(space, size_, nullptr);
  }
  bool there() const { return data_.ok(); }
  std::size_t rows() const { return size_[0]; }
  /// 0 for what is no table.
  std::size_t columns() const { return rank_ == 1 ? 1 : size_[1]; }
  bool bytes() const { return type_bytes() == 1; }
  std::vector<double> read(std::size_t first, std::size_t rows) const {
    if (rank_ < 1 || rank_ > 2) fail_input("{}: its array {} has {} axes; 1 or 2 are read", file_, path_, rank_);
    if (first > size_[0] || rows > size_[0] - first)
      fail_input("{}: its array {} has {} rows; {} from row {} on are asked for", file_, path_, size_[0], rows, first);
    // HDF5 has arrays of any size with nothing written; zlib packs to a thousandth at best.
    const std::size_t most = 1100 * (file_bytes_ + 1) / type_bytes();
    if (columns() > 0 && rows > most / columns())
      fail_input("{}: its array {} has {} rows of {}, which its {} bytes do not hold", file_, path_, rows, columns(),
                 file_bytes_);
    std::vector<double> out(rows * columns());
    if (out.empty()) return out;
    const hsize_t start[2]{first, 0}, count[2]{rows, size_[1]};
    const H5Handle space(H5Dget_space(data_), H5Sclose), memory(H5Screate_simple(rank_, count, nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr) < 0 ||
        H5Dread(data_, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, out.data()) < 0)
      fail_input("{}: its array {} cannot be read as numbers", file_, path_);
    return out;
  }

  /// Numbers of things, below 2^52: no sum of two of them is wrong in double.
  std::vector<std::size_t> counts(std::size_t first, std::size_t rows) const {
    constexpr std::size_t most = std::size_t(1) << 52;
    std::vector<std::size_t> out;
    for (const double value : read(first, rows)) {
      const std::optional<std::size_t> n = whole<std::size_t>(value);
      if (!n || *n > most)
        fail_input("{}: its array {} holds {}; numbers from 0 to {} are wanted", file_, path_, value, most);
      out.push_back(*n);
    }
    return out;
  }

 private:
  std::size_t type_bytes() const {
    const H5Handle type(H5Dget_type(data_), H5Tclose);
    return std::max<std::size_t>(H5Tget_size(type), 1);
  }
  hid_t open(hid_t group, const std::string& path) const {
    // Each part of the path is asked for: HDF5 takes the lack of a group as an error.
    for (std::size_t at = path.find('/'); at != path.npos; at = path.find('/', at + 1))
      if (!has_link(group, path.substr(0, at), file_)) return -1;
    if (!has_link(group, path, file_)) return -1;
    const hid_t data = H5Dopen2(group, path.c_str(), H5P_DEFAULT);
    if (data < 0) fail_input("{}: {} is no array, or is damaged", file_, path);
    return data;
  }
  const std::string& file_;
  std::string path_;
  std::size_t file_bytes_;
  H5Handle data_;
  int rank_ = 0;
  hsize_t size_[2]{0, 0};
};

herr_t take_name(hid_t, const char* name, const H5L_info_t*, void* out) {
  static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name)
      : name_(name), bytes_(bytes.size()), file_(open_bytes(bytes, name), H5Fclose), root_(open_root(), H5Gclose) {
    check_type();
  }

  Model read() {
    const std::size_t steps = array("Steps/Values").rows();
    part_ = first_of("Steps/PartOffsets");
    const Array of_step = array("Steps/NumberOfParts");
    const std::size_t parts = of_step.there() ? first_of("Steps/NumberOfParts")
                              : steps > 0     ? 1
                                              : need("NumberOfPoints").rows();
    points_ = need("NumberOfPoints").counts(part_, parts);
    Model model;
    read_points(model);
    if (array("Types").there())
      read_cells(model, "", 0, "cells");
    else
      read_cells(model, "Polygons/", 2, "polygons"), read_cells(model, "Strips/", 3, "triangle_strips");
    if (steps > 1) model.warnings.push_back(fmt::format("{}: has {} steps; the first is taken", name_, steps));
    return model;
  }

 private:
  hid_t open_root() const {
    const hid_t root = has_link(file_, "VTKHDF", name_) ? H5Gopen2(file_, "VTKHDF", H5P_DEFAULT) : -1;
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
  void read_points(Model& model) const {
    const Array places = need("Points");
    if (places.columns() != 3) fail_input("{}: its points have {} coordinates", name_, places.columns());
    const std::size_t first = first_of("Steps/PointOffsets");
    for (std::size_t p = 0, at = first; p < points_.size(); at += points_[p++]) {
      const std::vector<double> x = places.read(at, points_[p]);
      for (std::size_t i = 0; i < x.size(); i += 3) model.vertices.push_back({x[i], x[i + 1], x[i + 2]});
    }
    if (model.vertices.empty()) fail_input("{}: holds no points", name_);
    require_finite(model, name_);
    for (const std::string& name : names("PointData")) {
      const Array values = array("PointData/" + name);
      if (!values.there() || !is_point_array(name, values.columns())) continue;
      const std::string offsets = "Steps/PointDataOffsets/" + name;
      const std::size_t at = array(offsets).there() ? first_of(offsets) : first;
      take_point_array(model, {name, values.columns(), values.read(at, model.vertices.size()), values.bytes()}, name_);
    }
  }
  /// Cells of one group, of all parts; `kind` is the `column` of their offsets in Steps.
  void read_cells(Model& model, const std::string& group, std::size_t column, const char* kind) const {
    if (!array(group + "NumberOfCells").there()) return;
    const std::vector<std::size_t> cells = need(group + "NumberOfCells").counts(part_, points_.size());
    const std::vector<std::size_t> corners = need(group + "NumberOfConnectivityIds").counts(part_, points_.size());
    std::size_t cell = first_of("Steps/CellOffsets", column);
    std::size_t corner = first_of("Steps/ConnectivityIdOffsets", column), point = 0;
    std::vector<VtkCells> all;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      VtkCells& part = all.emplace_back();
      part.kind = kind;
      // The end of the last cell of a part is an offset of its own.
      if (cells[p] > 0) part.offsets = need(group + "Offsets").read(cell + part_ + p, cells[p] + 1);
      if (corners[p] > 0) part.connectivity = need(group + "Connectivity").read(corner, corners[p]);
      for (double& c : part.connectivity) c += static_cast<double>(point);
      if (group.empty()) part.types = need("Types").read(cell, cells[p]);
      cell += cells[p], corner += corners[p], point += points_[p];
    }
    add_vtk_cells(model, all, name_);
  }
  Array array(const std::string& path) const { return Array(root_, path, name_, bytes_); }
  Array need(const std::string& path) const {
    if (!array(path).there()) fail_input("{}: lacks {}", name_, path);
    return array(path);
  }
  /// A number of the first row; 0 without the array.
  std::size_t first_of(const std::string& path, std::size_t column = 0) const {
    const Array a = array(path);
    const std::vector<std::size_t> row = a.there() && a.rows() > 0 ? a.counts(0, 1) : std::vector<std::size_t>{};
    return column < row.size() ? row[column] : 0;
  }
  std::vector<std::string> names(const char* group) const {
    std::vector<std::string> out;
    if (!has_link(root_, group, name_)) return out;
    const H5Handle of(H5Gopen2(root_, group, H5P_DEFAULT), H5Gclose);
    hsize_t at = 0;
    if (!of.ok() || H5Literate(of, H5_INDEX_NAME, H5_ITER_INC, &at, take_name, &out) < 0)
      fail_input("{}: its group {} is damaged", name_, group);
    return out;
  }

  const std::string& name_;
  std::size_t bytes_;
  H5Handle file_, root_;
  std::size_t part_ = 0;             ///< the first one of the step
  std::vector<std::size_t> points_;  ///< of each part
};

}  // namespace

Model parse_vtkhdf(std::string_view bytes, const std::string& name) {
  const QuietHdf5 quiet;
  return Reader(bytes, name).read();
}

}  // namespace dreampm
