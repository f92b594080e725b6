// .vtkhdf files made by HDF5's own functions: with faces, with arrays that mean nothing here, with
// numbers that no file holds, and damaged. Those that VTK writes are read back in
// tests/python/test_import.py.
#include "dreampm/import/vtkhdf.h"

#include <gmock/gmock.h>

#include "dreampm/base/hdf5_handle.h"
#include "dreampm/import/point_file.h"
#include "geometry/meshes.h"

using namespace dreampm;
using testing::HasSubstr;

// Of damaged files HDF5 1.10 itself copies beyond the end of a header (H5Aexists), and does not
// free all. The sanitizers are to watch what the reader does: what HDF5 calls of libc is left out.
extern "C" const char* __asan_default_suppressions() { return "interceptor_via_lib:libhdf5\n"; }
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

namespace {

/// A file with the group VTKHDF of a type.
class VtkHdf : public InFolder {
 protected:
  class File {
   public:
    File(const std::filesystem::path& path, const std::string& type)
        : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose), root_(group("VTKHDF")) {
      const H5Handle text(H5Tcopy(H5T_C_S1), H5Tclose), one(H5Screate(H5S_SCALAR), H5Sclose);
      H5Tset_size(text, type.size());
      const H5Handle attribute(H5Acreate2(root_, "Type", text, one, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      H5Awrite(attribute, text, type.data());
    }
    H5Handle group(const std::string& path) const {
      return H5Handle(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    }
    /// An array of the group VTKHDF; rows of `columns` where it is not 0.
    void put(const std::string& path, const std::vector<double>& values, hsize_t columns = 0) const {
      const hsize_t size[2]{values.size() / std::max<hsize_t>(columns, 1), columns};
      const H5Handle data(make(path, H5T_NATIVE_DOUBLE, columns == 0 ? 1 : 2, size), H5Dclose);
      H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    /// An array of any size, in chunks of which none is written.
    void declare(const std::string& path, hid_t type, std::vector<hsize_t> size) const {
      H5Handle(make(path, type, static_cast<int>(size.size()), size.data()), H5Dclose);
    }

   private:
    hid_t make(const std::string& path, hid_t type, int rank, const hsize_t* size) const {
      const H5Handle space(H5Screate_simple(rank, size, nullptr), H5Sclose);
      const H5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      const hsize_t chunk[3]{1, 1, 1};
      if (size[0] > 1000) H5Pset_chunk(layout, rank, chunk);
      return H5Dcreate2(root_, path.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    }
    H5Handle file_, root_;
  };

  /// Four points of a square, with velocities and ids.
  File square(const std::string& type, const std::vector<double>& counts = {4}) const {
    File out(path(), type);
    out.put("NumberOfPoints", counts);
    out.put("Points", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
    out.group("VTKHDF/PointData");
    out.put("PointData/velocity", {0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4}, 3);
    out.put("PointData/id", {7, 8, 9, 10});
    return out;
  }
  static void put_cells(const File& out, const std::string& group, const std::vector<double>& connectivity,
                        const std::vector<double>& offsets) {
    out.put(group + "NumberOfCells", {static_cast<double>(offsets.size()) - 1});
    out.put(group + "NumberOfConnectivityIds", {static_cast<double>(connectivity.size())});
    out.put(group + "Connectivity", connectivity);
    out.put(group + "Offsets", offsets);
  }
  std::filesystem::path path() const { return folder / "a.vtkhdf"; }
  Model read() const { return read_point_file(path()); }
  std::string refused() const {
    return refusal([&] { read(); });
  }
};

TEST_F(VtkHdf, PolygonsAndStripsAreFaces) {
  {
    const File out = square("PolyData");
    out.group("VTKHDF/Polygons"), out.group("VTKHDF/Strips");
    put_cells(out, "Polygons/", {0, 1, 2, 3}, {0, 4});
    put_cells(out, "Strips/", {0, 1, 3, 2}, {0, 4});
  }
  const Model model = read();
  EXPECT_EQ(model.triangles.size(), 4u);
  EXPECT_EQ(model.velocities[3], (Vec3d{0, 0, 4}));
  EXPECT_EQ(model.ids, (std::vector<std::int64_t>{7, 8, 9, 10}));
}

TEST_F(VtkHdf, GridOfSeveralPartsAndKindsOfCells) {
  {
    const File out = square("UnstructuredGrid", {3, 1});
    out.put("NumberOfCells", {1, 2});
    out.put("NumberOfConnectivityIds", {3, 5});
    out.put("Connectivity", {0, 1, 2, 0, 0, 0, 0, 0});  // points count anew in each part
    out.put("Offsets", {0, 3, 0, 4, 5});
    out.put("Types", {5, 10, 1});  // a triangle; a tetrahedron and a vertex
  }
  const Model model = read();
  EXPECT_EQ(model.vertices.size(), 4u);
  EXPECT_EQ(model.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
  EXPECT_THAT(model.warnings, testing::ElementsAre(HasSubstr("1 of its cells enclose volumes")));
}

TEST_F(VtkHdf, CellsNameWhatIsThere) {
  const std::tuple<std::vector<double>, std::vector<double>, const char*> wrong[]{
      {{0, 1, 4}, {0, 3}, "its cells name the point 4; 0 to 3 are there"},
      {{0, 1, -1}, {0, 3}, "its cells name the point -1"},
      {{0, 1, 2}, {0, 4}, "its cells name the place 4"},
      {{0, 1, 2}, {0, std::nan("")}, "its cells name the place nan"}};
  for (const auto& [connectivity, offsets, message] : wrong) {
    {
      const File out = square("PolyData");
      out.group("VTKHDF/Polygons");
      put_cells(out, "Polygons/", connectivity, offsets);
    }
    EXPECT_THAT(refused(), HasSubstr(message));
  }
}

TEST_F(VtkHdf, ArraysWithoutMeaningArePassedOver) {
  {
    const File out = square("PolyData");
    const H5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(text, 8);
    out.declare("PointData/label", text, {4});
    out.declare("PointData/gradient", H5T_NATIVE_FLOAT, {4, 3, 3});
    out.declare("PointData/u", H5T_NATIVE_FLOAT, {2, 2, 2});  // no table, though of a name that is known
    out.declare("PointData/rgb", H5T_NATIVE_FLOAT, {4, 9});
  }
  const Model model = read();
  EXPECT_EQ(model.vertices.size(), 4u);
  EXPECT_EQ(model.velocities.size(), 4u);
  EXPECT_TRUE(model.colors.empty());
}

TEST_F(VtkHdf, IdsAreWholeNumbers) {
  for (const double id : {std::nan(""), 1e300, -1e19, 0.5}) {
    {
      const File out = square("PolyData");
      out.put("PointData/particleid", {0, 1, id, 3});
    }
    EXPECT_THAT(refused(), HasSubstr("a.vtkhdf: the id of point 2 is " + fmt::format("{}: a whole number", id)));
  }
}

TEST_F(VtkHdf, NoMemoryIsTakenForWhatTheFileDoesNotHold) {
  constexpr hsize_t many = 1000000000000;  // 22 TiB of points in double
  {
    const File out(path(), "PolyData");
    out.put("NumberOfPoints", {double(many)});
    out.declare("Points", H5T_NATIVE_FLOAT, {many, 3});
  }
  EXPECT_THAT(refused(), HasSubstr("a.vtkhdf: its array Points has 1000000000000 rows of 3, which its"));
  {
    const File out(path(), "PolyData");
    out.declare("NumberOfPoints", H5T_NATIVE_INT64, {many});
    out.put("Points", {0, 0, 0}, 3);
  }
  EXPECT_THAT(refused(), HasSubstr("its array NumberOfPoints has 1000000000000 rows of 1, which its"));
}

TEST_F(VtkHdf, CountsAreWholeNumbers) {
  for (const std::vector<double>& counts :
       {std::vector<double>{-4}, {4.5}, {std::nan("")}, {1e300}, {18446744073709551615.0, 5}, {-1, 5}}) {
    square("PolyData", counts);
    EXPECT_THAT(refused(), HasSubstr("its array NumberOfPoints holds"));
  }
  square("PolyData", {5});
  EXPECT_THAT(refused(), HasSubstr("its array Points has 4 rows; 5 from row 0 on are asked for"));
  square("PolyData", {4503599627370496.0, 4503599627370496.0});
  EXPECT_THAT(refused(), HasSubstr("its array Points has 4 rows"));
}

/// Changed anywhere or cut, the file is refused or read, and nothing else.
TEST_F(VtkHdf, AnyDamageIsAnErrorOrHarmless) {
  {
    const File out = square("PolyData");
    out.group("VTKHDF/Polygons");
    put_cells(out, "Polygons/", {0, 1, 2, 3}, {0, 4});
  }
  std::ifstream in(path(), std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  ASSERT_GT(text.size(), 4000u);
  std::size_t refused = 0;
  const auto check = [&](const std::string& damaged) {
    try {
      EXPECT_LE(parse_vtkhdf(damaged, "a").vertices.size(), 1000u);
    } catch (const InputError&) {
      ++refused;
    }
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (at % 64 == 0) check(text.substr(0, at));
    if (text[at] == 0 && at % 5 != 0) continue;  // most of the file is empty room
    std::string damaged = text;
    damaged[at] = '\xff';
    check(damaged);
  }
  EXPECT_GT(refused, 100u);
  // The names of a group are in a heap: without it nothing of the group is passed over in silence.
  std::size_t heaps = 0;
  for (std::size_t at = text.find("HEAP"); at != text.npos; at = text.find("HEAP", at + 1), ++heaps)
    EXPECT_THROW(parse_vtkhdf(std::string(text).replace(at, 4, "heap"), "a"), InputError) << at;
  EXPECT_EQ(heaps, 4u) << "of the file, VTKHDF, PointData and Polygons";
}

}  // namespace
