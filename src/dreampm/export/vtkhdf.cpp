// VTKHDF: polygonal data over time in one HDF5 file, for vtkHDFReader and ParaView. Layout: "VTKHDF
// File Format", version 2.0 (https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html).
#include <fmt/format.h>

#include <numeric>

#include "dreampm/base/error.h"
#include "dreampm/base/narrow.h"
#include "dreampm/base/replacement.h"
#include "dreampm/export/formats.h"
#include "dreampm/export/hdf5_output.h"
#include "dreampm/math/srgb.h"

namespace dreampm::exchange {
namespace fs = std::filesystem;
namespace {

/// An array that grows along its first axis; packed, in chunks.
class Growing {
 public:
  Growing(hid_t group, const std::string& name, hid_t type, hsize_t columns, const Hdf5Output& file)
      : columns_(columns), file_(file), data_(make(group, name, type), H5Dclose) {
    if (!data_.ok()) file_.fail();
  }
  void append(const void* values, hid_t memory_type, hsize_t rows) {
    if (rows == 0) return;
    const hsize_t start[2]{rows_, 0}, count[2]{rows, columns_}, size[2]{rows_ + rows, columns_};
    if (H5Dset_extent(data_, size) < 0) file_.fail();
    const H5Handle space(H5Dget_space(data_), H5Sclose), memory(H5Screate_simple(rank(), count, nullptr), H5Sclose);
    if (!space.ok() || !memory.ok() || H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr) < 0 ||
        H5Dwrite(data_, memory_type, memory, space, H5P_DEFAULT, values) < 0)
      file_.fail();
    rows_ += rows;
  }
  hsize_t rows() const { return rows_; }

 private:
  /// One column is a plain list.
  int rank() const { return columns_ == 0 ? 1 : 2; }
  hid_t make(hid_t group, const std::string& name, hid_t type) const {
    constexpr hsize_t chunk_rows = 16384;
    const hsize_t size[2]{0, columns_}, most[2]{H5S_UNLIMITED, columns_}, chunk[2]{chunk_rows, columns_};
    const H5Handle space(H5Screate_simple(rank(), size, most), H5Sclose);
    const H5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(layout, rank(), chunk), H5Pset_shuffle(layout), H5Pset_deflate(layout, 3);
    H5Pset_obj_track_times(layout, false);  // equal contents give equal files
    return H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  }
  hsize_t columns_, rows_ = 0;
  const Hdf5Output& file_;
  H5Handle data_;
};

/// A file of polygonal data with steps.
class VtkHdfFile {
 public:
  explicit VtkHdfFile(const fs::path& target)
      : replacement_(target),
        file_(replacement_.temporary(), target),
        root_(group(file_.id(), "VTKHDF")),
        steps_(group(root_, "Steps")),
        point_data_(group(root_, "PointData")),
        point_data_offsets_(group(steps_, "PointDataOffsets")),
        points_count_(list<std::int64_t>(root_, "NumberOfPoints")),
        times_(list<double>(steps_, "Values")),
        part_offsets_(list<std::int64_t>(steps_, "PartOffsets")),
        parts_(list<std::int64_t>(steps_, "NumberOfParts")),
        point_offsets_(list<std::int64_t>(steps_, "PointOffsets")),
        cell_offsets_(steps_, "CellOffsets", h5_type<std::int64_t>(), 4, file_),
        connectivity_offsets_(steps_, "ConnectivityIdOffsets", h5_type<std::int64_t>(), 4, file_) {
    const std::int64_t version[2]{2, 0};
    put(root_, "Version", H5T_STD_I64LE, version, 2);
    write_type();
    for (const char* kind : {"Vertices", "Lines", "Polygons", "Strips"})
      cells_.push_back(std::make_unique<Cells>(*this, kind));
  }

  enum Kind { vertices = 0, polygons = 2 };

  /// A step: its points, in double where `shift` asks for it, and its cells of one kind.
  void begin(double time, std::span<const Vec3f> points, const Vec3d& shift) {
    file_.check();
    const std::array<std::int64_t, 4> cell_starts = starts(&Cells::cells), corner_starts = starts(&Cells::corners);
    cell_offsets_.append(cell_starts.data(), H5T_NATIVE_INT64, 1);
    connectivity_offsets_.append(corner_starts.data(), H5T_NATIVE_INT64, 1);
    times_.append(&time, H5T_NATIVE_DOUBLE, 1);
    add(part_offsets_, steps_done_++);
    add(parts_, 1);
    add(points_count_, static_cast<std::int64_t>(points.size()));
    add(point_offsets_, points_ ? static_cast<std::int64_t>(points_->rows()) : 0);
    const bool exact = !(shift == Vec3d{});
    if (!points_)
      points_ = std::make_unique<Growing>(root_, "Points", exact ? h5_type<double>() : h5_type<float>(), 3, file_);
    if (!exact) return points_->append(points.data(), H5T_NATIVE_FLOAT, points.size());
    std::vector<Vec3d> places;
    places.reserve(points.size());
    for (const Vec3f& p : points) places.push_back(static_cast<Vec3d>(p) + shift);
    points_->append(places.data(), H5T_NATIVE_DOUBLE, places.size());
  }
  /// Cells of `corners` points each, of the step that was begun; none of the other kinds.
  void cells(Kind kind, std::span<const std::int64_t> points, std::int64_t corners) {
    for (int k = 0; k < 4; ++k)
      cells_[std::size_t(k)]->append(k == kind ? points : std::span<const std::int64_t>{}, corners);
  }
  /// A value for each point of the step.
  template <class T>
  void point_data(const std::string& name, const T* values, hsize_t rows, hsize_t columns) {
    auto& column = columns_[name];
    if (!column.data) {
      column.data = std::make_unique<Growing>(point_data_, name, h5_type<T>(), columns, file_);
      column.offsets = std::make_unique<Growing>(point_data_offsets_, name, H5T_STD_I64LE, 0, file_);
    }
    column.pad(steps_done_);
    column.data->append(values, h5_type<T>(), rows);
  }

  /// Everything is in the file.
  void seal() {
    put(steps_, "NSteps", H5T_STD_I64LE, &steps_done_, 1);
    for (auto& [name, column] : columns_) column.pad(steps_done_);
    if (H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) file_.fail();
    file_.check();
  }
  void commit() { replacement_.commit(); }

 private:
  struct Cells {
    Cells(VtkHdfFile& f, const std::string& kind)
        : group(f.group(f.root_, kind)),
          count(f.list<std::int64_t>(group, "NumberOfCells")),
          ids(f.list<std::int64_t>(group, "NumberOfConnectivityIds")),
          connectivity(f.list<std::int64_t>(group, "Connectivity")),
          offsets(f.list<std::int64_t>(group, "Offsets")) {}
    void append(std::span<const std::int64_t> points, std::int64_t each) {
      const auto n = static_cast<std::int64_t>(points.size()) / each;
      add(count, n), add(ids, static_cast<std::int64_t>(points.size()));
      connectivity.append(points.data(), H5T_NATIVE_INT64, points.size());
      std::vector<std::int64_t> starts(static_cast<std::size_t>(n) + 1);
      for (std::size_t i = 0; i < starts.size(); ++i) starts[i] = static_cast<std::int64_t>(i) * each;
      offsets.append(starts.data(), H5T_NATIVE_INT64, starts.size());
      cells += n, corners += static_cast<std::int64_t>(points.size());
    }
    H5Handle group;
    Growing count, ids, connectivity, offsets;
    std::int64_t cells = 0, corners = 0;
  };
  struct Column {
    /// Steps without points may lack the column.
    void pad(std::int64_t steps) {
      while (static_cast<std::int64_t>(offsets->rows()) < steps) add(*offsets, static_cast<std::int64_t>(data->rows()));
    }
    std::unique_ptr<Growing> data, offsets;
  };

  static void add(Growing& list, std::int64_t value) { list.append(&value, H5T_NATIVE_INT64, 1); }
  template <class T>
  Growing list(hid_t parent, const std::string& name) {
    return Growing(parent, name, h5_type<T>(), 0, file_);
  }
  H5Handle group(hid_t parent, const std::string& name) {
    H5Handle made(parent < 0 ? -1 : H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    if (!made.ok()) file_.fail();
    return made;
  }
  std::array<std::int64_t, 4> starts(std::int64_t Cells::* total) const {
    std::array<std::int64_t, 4> out{};
    for (std::size_t k = 0; k < 4; ++k) out[k] = (*cells_[k]).*total;
    return out;
  }
  void put(hid_t object, const char* name, hid_t type, const void* values, hsize_t count) {
    const H5Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
    const H5Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!attribute.ok() || H5Awrite(attribute, type, values) < 0) file_.fail();
  }
  /// Text of a fixed length in ASCII: the reader takes no other.
  void write_type() {
    constexpr std::string_view text = "PolyData";
    const H5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, text.size());
    put(root_, "Type", type, text.data(), 1);
  }

  QuietHdf5 quiet_;  // also while all below is closed
  Replacement replacement_;
  Hdf5Output file_;
  H5Handle root_, steps_, point_data_, point_data_offsets_;
  Growing points_count_, times_, part_offsets_, parts_, point_offsets_, cell_offsets_, connectivity_offsets_;
  std::vector<std::unique_ptr<Cells>> cells_;
  std::unique_ptr<Growing> points_;
  std::map<std::string, Column> columns_;
  std::int64_t steps_done_ = 0;
};

std::vector<std::int64_t> count_up(std::size_t n) {
  std::vector<std::int64_t> out(n);
  std::iota(out.begin(), out.end(), std::int64_t{0});
  return out;
}

void add_particles(VtkHdfFile& out, double time, const ClipInfo& clip, const ParticleFrame& p) {
  out.begin(time, p.position, clip.shift);
  out.cells(VtkHdfFile::vertices, count_up(p.size()), 1);
  const hsize_t n = p.size();
  out.point_data("velocity", n > 0 ? &p.velocity[0].x : nullptr, n, 3);
  out.point_data("id", p.id.data(), n, 0);
  out.point_data("material", p.material.data(), n, 0);
  for (const auto& [name, values] : p.columns)
    if (values.size() == p.size()) out.point_data(name, values.data(), n, 0);
  if (!p.color.empty()) out.point_data("color", p.color[0].data(), n, 4);
}

/// The bytes of a color in sRGB, which ParaView shows as they are.
std::vector<std::uint8_t> bytes_of(const std::vector<float>& linear) {
  std::vector<std::uint8_t> out;
  out.reserve(linear.size());
  for (const float v : linear) out.push_back(srgb_byte(v));
  return out;
}

void add_attribute(VtkHdfFile& out, const VertexAttribute& a, std::size_t vertices) {
  const hsize_t n = vertices;
  switch (a.kind) {
    case AttributeKind::number:
      return out.point_data(a.name, a.values.data(), n, 0);
    case AttributeKind::vector:
      return out.point_data(a.name, a.values.data(), n, 3);
    case AttributeKind::color:
      return out.point_data(a.name, bytes_of(a.values).data(), n, 3);
    case AttributeKind::whole:
      break;
  }
  const std::vector<std::int32_t> whole(a.values.begin(), a.values.end());
  out.point_data(a.name, whole.data(), n, 0);
}

/// The attributes of meshes as those of one; all have the same.
VertexAttributes joined(std::span<const VertexAttributes> of_meshes) {
  VertexAttributes all;
  for (const VertexAttributes& attributes : of_meshes)
    for (std::size_t a = 0; a < attributes.size(); ++a) {
      if (a == all.size()) all.push_back({attributes[a].name, attributes[a].kind, {}});
      all[a].values.insert(all[a].values.end(), attributes[a].values.begin(), attributes[a].values.end());
    }
  return all;
}

/// Meshes as one, whose points know which of them they belong to: `number` of each, by the name
/// `what`.
template <class Number>
void add_meshes(VtkHdfFile& out, double time, const Vec3d& shift, std::span<const TriMesh> meshes,
                std::span<const Number> numbers, const char* what, std::span<const VertexAttributes> attributes = {}) {
  TriMesh all;
  std::vector<Number> number;
  std::vector<std::int64_t> corners;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const TriMesh& mesh = meshes[m];
    const auto first = static_cast<std::int64_t>(all.vertices.size());
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t v : t) corners.push_back(first + v);
    const std::size_t n = mesh.vertices.size();
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    const auto take = [&](std::vector<Vec3f>& to, const std::vector<Vec3f>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    take(all.normals, mesh.normals), take(all.velocities, mesh.velocities);
    number.insert(number.end(), n, numbers[m]);
  }
  const hsize_t n = all.vertices.size();
  out.begin(time, all.vertices, shift);
  out.cells(VtkHdfFile::polygons, corners, 3);
  // What some of the meshes lack is left out.
  if (n > 0 && all.velocities.size() == n) out.point_data("velocity", &all.velocities[0].x, n, 3);
  if (n > 0 && all.normals.size() == n) out.point_data("Normals", &all.normals[0].x, n, 3);
  for (const VertexAttribute& a : joined(attributes))
    if (a.vertices() == n) add_attribute(out, a, n);
  out.point_data(what, number.data(), n, 0);
}

/// FILE where the clip has particles, foam, meshes or objects alone; else FILE-particles,
/// FILE-foam, FILE-surface and FILE-colliders.
std::vector<fs::path> vtkhdf_files(const ClipInfo& clip, const fs::path& file) {
  std::vector<std::string> parts;
  if (clip.particles) parts.emplace_back("particles");
  if (clip.foam) parts.emplace_back("foam");
  if (!clip.meshed.empty()) parts.emplace_back("surface");
  if (!clip.objects.empty()) parts.emplace_back("colliders");
  if (parts.size() < 2) return {file};
  std::vector<fs::path> files;
  for (const std::string& part : parts)
    files.push_back(file.parent_path() / fmt::format("{}-{}{}", file.stem().string(), part, file.extension().string()));
  return files;
}

class VtkHdfWriter final : public ClipWriter {
 public:
  VtkHdfWriter(const ClipInfo& clip, const fs::path& file) : clip_(clip) {
    const std::vector<fs::path> files = vtkhdf_files(clip, file);
    std::size_t next = 0;
    if (clip.particles) particles_.emplace(files[next++]);
    if (clip.foam) foam_.emplace(files[next++]);
    if (!clip.meshed.empty()) meshes_.emplace(files[next++]);
    if (!clip.objects.empty()) objects_.emplace(files[next++]);
    for (const int m : clip.meshed) materials_.push_back(narrow<std::uint8_t>(m, "materials"));
    for (std::size_t o = 0; o < clip.objects.size(); ++o) colliders_.push_back(narrow<std::int32_t>(o, "colliders"));
  }
  void add(const ClipFrame& frame) override {
    const double time = clip_.time(frame.number);
    if (particles_) add_particles(*particles_, time, clip_, frame.particles);
    if (foam_) add_particles(*foam_, time, clip_, frame.foam);
    if (meshes_)
      add_meshes<std::uint8_t>(*meshes_, time, clip_.shift, frame.meshes, materials_, "material", frame.attributes);
    if (!objects_) return;
    std::vector<TriMesh> standing;
    for (std::size_t o = 0; o < clip_.objects.size(); ++o)
      standing.push_back(placed(clip_.objects[o], frame.objects[o]));
    add_meshes<std::int32_t>(*objects_, time, clip_.shift, standing, colliders_, "collider");
  }
  void finish() override {
    // All are whole before one appears.
    for (auto* file : {&particles_, &foam_, &meshes_, &objects_})
      if (*file) (*file)->seal();
    for (auto* file : {&particles_, &foam_, &meshes_, &objects_})
      if (*file) (*file)->commit();
  }

 private:
  ClipInfo clip_;
  std::optional<VtkHdfFile> particles_, foam_, meshes_, objects_;
  std::vector<std::uint8_t> materials_;  ///< of the meshes
  std::vector<std::int32_t> colliders_;  ///< numbers of the objects
};

std::unique_ptr<ClipWriter> write_vtkhdf_clip(const ClipInfo& clip, const fs::path& file) {
  return std::make_unique<VtkHdfWriter>(clip, file);
}

}  // namespace

Format vtkhdf_format() {
  return {"vtkhdf", "a time series for ParaView and VTK", ".vtkhdf", false, vtkhdf_files, write_vtkhdf_clip};
}

}  // namespace dreampm::exchange
