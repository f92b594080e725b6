// .vtkhdf files. An input is no file but a list of changes to the arrays of a right one, which HDF5
// writes: so it is our reader that meets wrong counts, types and sizes. In half of them bytes of
// that file are changed too.
#include "dreampm/import/vtkhdf.h"

#include <fuzzer/FuzzedDataProvider.h>

#include <map>

#include "dreampm/base/hdf5_handle.h"
#include "model.h"

using namespace dreampm;
namespace {

struct Array {
  std::vector<double> values;
  hsize_t columns = 0;  ///< 0: it has one axis
  int type = 0;
  hsize_t claimed = 0;  ///< rows that are claimed and not written
};
using Arrays = std::map<std::string, Array>;

Arrays right_file() {
  Arrays all{{"NumberOfPoints", {{4}}},
             {"Points", {{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3}},
             {"PointData/velocity", {{0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4}, 3}},
             {"PointData/color", {{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3}},
             {"PointData/id", {{7, 8, 9, 10}}},
             {"Steps/Values", {{0, 1}}},
             {"Steps/PartOffsets", {{0, 0}}},
             {"Steps/NumberOfParts", {{1, 1}}},
             {"Steps/PointOffsets", {{0, 0}}},
             {"Steps/CellOffsets", {{0, 0, 0, 0}, 4}},
             {"Steps/ConnectivityIdOffsets", {{0, 0, 0, 0}, 4}},
             {"Steps/PointDataOffsets/id", {{0, 0}}}};
  for (const std::string group : {"Polygons/", "Strips/", ""}) {
    all[group + "NumberOfCells"] = {{2}};
    all[group + "NumberOfConnectivityIds"] = {{7}};
    all[group + "Connectivity"] = {{0, 1, 2, 3, 0, 1, 2}};
    all[group + "Offsets"] = {{0, 4, 7}};
  }
  all["Types"] = {{9, 5}};
  return all;
}

hid_t type_of(int type) {
  const hid_t all[]{H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_STD_I64LE, H5T_STD_U8LE, H5T_STD_I16BE, H5T_C_S1};
  return all[static_cast<std::size_t>(type) % std::size(all)];
}

void change(FuzzedDataProvider& in, Arrays& arrays) {
  auto at = std::next(arrays.begin(), in.ConsumeIntegralInRange<int>(0, static_cast<int>(arrays.size()) - 1));
  Array& array = at->second;
  switch (in.ConsumeIntegralInRange<int>(0, 6)) {
    case 0:
      arrays.erase(at);
      break;
    case 1:
      array.type = in.ConsumeIntegral<std::uint8_t>();
      break;
    case 2:
      array.columns = in.ConsumeIntegralInRange<hsize_t>(0, 9);
      break;
    case 3:
      array.claimed = in.ConsumeIntegral<hsize_t>();
      break;
    case 4:
      array.values.resize(in.ConsumeIntegralInRange<std::size_t>(0, 40));
      break;
    default:
      if (!array.values.empty())
        array.values[in.ConsumeIntegralInRange<std::size_t>(0, array.values.size() - 1)] =
            in.ConsumeBool() ? in.ConsumeIntegralInRange<int>(-2, 20) : in.ConsumeFloatingPoint<double>();
  }
}

void write(hid_t root, const std::string& path, const Array& array) {
  const H5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose), layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const hsize_t columns = std::max<hsize_t>(array.columns, 1), chunk[2]{64, columns};
  hsize_t size[2]{array.values.size() / columns, columns};
  const int rank = array.columns == 0 ? 1 : 2;
  if (array.claimed > 0) size[0] = array.claimed, H5Pset_chunk(layout, rank, chunk);
  const H5Handle space(H5Screate_simple(rank, size, nullptr), H5Sclose);
  const H5Handle data(H5Dcreate2(root, path.c_str(), type_of(array.type), space, links, layout, H5P_DEFAULT), H5Dclose);
  if (data.ok() && array.claimed == 0 && size[0] > 0)
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data());
}

std::string file_of(const Arrays& arrays, const std::string& type) {
  const QuietHdf5 quiet;
  const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, 1 << 16, false);
  const H5Handle file(H5Fcreate("made", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  {
    const H5Handle root(H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    const H5Handle text(H5Tcopy(H5T_C_S1), H5Tclose), one(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(text, type.size());
    const H5Handle attribute(H5Acreate2(root, "Type", text, one, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute, text, type.data());
    for (const auto& [path, array] : arrays) write(root, path, array);
  }
  H5Fflush(file, H5F_SCOPE_LOCAL);
  std::string bytes(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)), '\0');
  H5Fget_file_image(file, bytes.data(), bytes.size());
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  Arrays arrays = right_file();
  const bool polygons = in.ConsumeBool(), damaged = in.ConsumeBool();
  if (polygons)
    for (const char* path : {"NumberOfCells", "NumberOfConnectivityIds", "Connectivity", "Offsets", "Types"})
      arrays.erase(path);
  for (int n = 0; in.remaining_bytes() > 0 && !arrays.empty() && !(damaged && n == 3); ++n) change(in, arrays);
  std::string file = file_of(arrays, polygons ? "PolyData" : "UnstructuredGrid");
  while (in.remaining_bytes() > 0)
    file[in.ConsumeIntegral<std::uint16_t>() % file.size()] ^= in.ConsumeIntegral<char>();
  fuzz::read_model_of(reinterpret_cast<const std::uint8_t*>(file.data()), file.size(), 20000, parse_vtkhdf);
  return 0;
}
