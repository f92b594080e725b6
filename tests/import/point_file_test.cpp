// Files of points from other programs that are damaged, or of a kind that is not read. What whole
// ones hold is read back in tests/python/test_import.py, from files that VTK wrote.
#include "dreampm/import/point_file.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include "dreampm/import/bgeo.h"
#include "dreampm/import/vtk_legacy.h"
#include "dreampm/import/vtk_xml.h"
#include "geometry/meshes.h"

using namespace dreampm;
using testing::HasSubstr;

namespace {

class PointFile : public InFolder {};

template <class T>
void put_big(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  std::reverse(bytes, bytes + sizeof value);
  out.append(bytes, sizeof value);
}

/// A classic .bgeo of two points with velocities.
std::string small_bgeo(std::int32_t version = 5) {
  std::string out = "BgeoV";
  for (const std::int32_t n : {version, 2, 0, 0, 0, 1, 0, 0, 0}) put_big(out, n);
  put_big(out, std::uint16_t(1)), out += "v";
  put_big(out, std::uint16_t(3)), put_big(out, std::int32_t(5));
  for (int k = 0; k < 3; ++k) put_big(out, 0.0f);
  for (const float x : {1.0f, 2.0f, 3.0f, 2.0f, 7.0f, 8.0f, 9.0f, 4.0f, 5.0f, 6.0f, 1.0f, -7.0f, -8.0f, -9.0f})
    put_big(out, x);
  return out;
}

const std::string small_vtk =
    "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0  1 0 0  1 1 0  0 1 0\n"
    "POLYGONS 1 5\n4 0 1 2 3\nPOINT_DATA 4\nSCALARS height double\nLOOKUP_TABLE default\n1 2 3 4\n"
    "VECTORS vel float\n0 0 1  0 0 2  0 0 3  0 0 4\nCELL_DATA 1\nVECTORS velocity float\n9 9 9\n";

const std::string small_vtp =
    "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
    "header_type=\"UInt32\"><PolyData><Piece NumberOfPoints=\"2\"><PointData><DataArray type=\"Float32\" Name=\"v\" "
    "NumberOfComponents=\"3\" format=\"binary\">GAAAAAAAgD8AAABAAABAQAAAgEAAAKBAAADAQA==</DataArray></PointData>"
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 2 3</DataArray></Points>"
    "</Piece></PolyData></VTKFile>";

TEST_F(PointFile, ClassicBgeoHasWeights) {
  const Model model = read_point_file(file("two.bgeo", small_bgeo()));
  ASSERT_EQ(model.vertices.size(), 2u);
  EXPECT_EQ(model.vertices[0], (Vec3d{0.5, 1, 1.5}));
  EXPECT_EQ(model.velocities[0], (Vec3d{7, 8, 9}));
  EXPECT_EQ(model.velocities[1], (Vec3d{-7, -8, -9}));
}

TEST_F(PointFile, LegacyDataOfCellsAreNotThoseOfPoints) {
  const Model model = read_point_file(file("square.vtk", small_vtk));
  EXPECT_EQ(model.triangles.size(), 2u);
  EXPECT_EQ(model.velocities[3], (Vec3d{0, 0, 4}));
}

TEST_F(PointFile, InlineBase64) {
  const Model model = read_point_file(file("two.VTP", small_vtp));
  EXPECT_EQ(model.vertices[1], (Vec3d{1, 2, 3}));
  EXPECT_EQ(model.velocities[1], (Vec3d{4, 5, 6}));
}

TEST_F(PointFile, ArraysWithoutMeaningArePassedOver) {
  std::string text = small_vtp;
  text.insert(text.find("<DataArray"),
              "<DataArray type=\"String\" Name=\"label\" format=\"ascii\">97 0 98 0</DataArray>"
              "<DataArray type=\"Bit\" Name=\"chosen\" format=\"binary\">AQ==</DataArray>"
              "<DataArray type=\"Float32\" Name=\"stress\" NumberOfComponents=\"9\" format=\"ascii\">-</DataArray>");
  EXPECT_EQ(read_point_file(file("two.vtp", text)).velocities[1], (Vec3d{4, 5, 6}));
}

/// The files as VTK 9 writes them: a text is a line of ASCII, or has its length before it; bits are
/// packed.
TEST_F(PointFile, LegacyTextsAndBitsArePassedOver) {
  const auto with = [&](const std::string& arrays) {
    const std::string head = small_vtk.substr(0, small_vtk.find("SCALARS"));
    return head + "FIELD FieldData 3\n" + arrays + "v 3 4 float\n0 0 1  0 0 2  0 0 3  0 0 4\n";
  };
  const std::string ascii = with("label 1 4 string\na%20b\n\nc\n\n\nchosen 1 4 bit\n1 0 1 1 \n");
  EXPECT_EQ(read_point_file(file("a.vtk", ascii)).velocities[3], (Vec3d{0, 0, 4}));
  EXPECT_THAT(refusal([&] { read_point_file(file("a.vtk", ascii.substr(0, ascii.find("\n\nc") + 1))); }),
              HasSubstr("a.vtk: is cut short"));

  std::string binary = "# vtk DataFile Version 5.1\nvtk output\nBINARY\nDATASET POLYDATA\nPOINTS 3 float\n";
  for (int k = 0; k < 9; ++k) put_big(binary, float(k));
  binary +=
      "\nPOINT_DATA 3\nFIELD FieldData 3\nlabel 1 3 string\n\xc3"
      "a b\x80\x64" +
      std::string(100, 'x') + "\xc0";
  binary += "\nbit 1 3 bit\n\xa0\nv 3 3 float\n";
  for (int k = 0; k < 9; ++k) put_big(binary, float(k));
  EXPECT_EQ(read_point_file(file("b.vtk", binary)).velocities[2], (Vec3d{6, 7, 8}));
  for (const char* end : {"\x80\x64", "string\n", "a b"})
    EXPECT_THAT(refusal([&] { read_point_file(file("b.vtk", binary.substr(0, binary.find(end) + std::strlen(end)))); }),
                HasSubstr("b.vtk: is cut short"))
        << end;
  // A length beyond any file.
  std::string long_text = binary;
  long_text.replace(long_text.find("\xc3"), 4, "\x3f\xff\xff\xff\xff\xff\xff\xff");
  EXPECT_THAT(refusal([&] { read_point_file(file("b.vtk", long_text)); }), HasSubstr("b.vtk: is cut short"));
}

TEST_F(PointFile, SaysWhatIsWrong) {
  const auto with = [](std::string text, const std::string& old, const std::string& now) {
    return text.replace(text.find(old), old.size(), now);
  };
  const std::tuple<const char*, std::string, const char*> wrong[]{
      {"a.bgeo", "\x7fNSJb", "is a .bgeo of JSON, as Houdini writes since version 12"},
      {"a.bgeo", "[\"fileversion\",", "is a .bgeo of JSON"},
      {"a.bgeo", "PK", "does not begin as a .bgeo does"},
      {"a.bgeo", small_bgeo(4), "is of version 4; 5 is read"},
      {"a.vtk", "solid", "does not begin with \"# vtk DataFile Version \""},
      {"a.vtk", with(small_vtk, "POLYDATA", "RECTILINEAR_GRID"), "its data set is rectilinear_grid"},
      {"a.vtk", with(small_vtk, "POINTS 4", "POINTS 4000000000"), "4000000000 points, which its"},
      {"a.vtk", with(small_vtk, "1 1 0", "1 x 0"), "POINTS holds \"x\", which is no number"},
      {"a.vtk", with(small_vtk, "4 0 1 2 3", "4 0 1 2 4"), "its cells name the point 4"},
      {"a.vtk", with(small_vtk, "0 0 3 ", "0 0 nan"), "the velocity of point 2 is not finite"},
      {"a.vtk", with(small_vtk, "height double\nLOOKUP_TABLE default\n1 2 3 4", "id double 1\n1 2 nan 4"),
       "the id of point 2 is nan: a whole number is wanted"},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
       "property double id\nend_header\n0 0 0 1e300\n",
       "the id of vertex 0 is 1e+300: a whole number is wanted"},
      {"a.vtp", "<VTKFile type=\"ImageData\"></VTKFile>", "holds ImageData; PolyData and UnstructuredGrid are read"},
      {"a.vtp", "<VTKFile", "is no XML"},
      {"a.vtp", with(small_vtp, "header_type", "compressor=\"vtkLZ4DataCompressor\" header_type"),
       "is packed by vtkLZ4DataCompressor; files packed by zlib"},
      {"a.vtp", with(small_vtp, "GAAAAAAA", "/////wAA"), "its array v is cut short"},
      {"a.vtp", with(small_vtp, "0 0 0 1 2 3", "0 0 0 1 2"), "has 5 coordinates for 2 points"},
      {"a.vtkhdf", "x", "is no HDF5 file, or is damaged"},
      {"a.abc", "x", "points are read from .ply, .vtk, .vtp, .vtu, .vtkhdf, .bgeo"},
      {"a.vtk", "", "is empty, points are wanted"}};
  for (const auto& [name, text, message] : wrong) {
    const auto path = file(name, text);
    EXPECT_THAT(refusal([&] { read_point_file(path); }), testing::AllOf(HasSubstr(name), HasSubstr(message)));
  }
}

TEST_F(PointFile, LegacyCountsOfPointsFitTheList) {
  const auto with = [&](const char* polygons) {
    std::string text = small_vtk;
    return file("a.vtk", text.replace(text.find("1 5\n4 0 1 2 3"), 13, polygons));
  };
  // 2^64 - 2048 and two more numbers: a sum in 64 bits would go back to where it came from.
  const std::pair<const char*, const char*> wrong[]{
      {"1 5\n18446744073709549568 0 1 2 3", "cell 0 of its polygons has 1.844674407370955e+19 points, but 4 numbers"},
      {"2 6\n3 0 1 2 -1 0", "cell 1 of its polygons has -1 points, but 1 numbers follow"},
      {"2 6\n3 0 1 2 4 0", "cell 1 of its polygons has 4 points, but 1 numbers follow"},
      {"1 5\n3.5 0 1 2 3", "cell 0 of its polygons has 3.5 points"},
      {"1 5\nnan 0 1 2 3", "cell 0 of its polygons has nan points"},
      {"2 5\n4 0 1 2 3", "its polygons are 2, but its list of them holds 1"}};
  for (const auto& [polygons, message] : wrong) {
    const auto path = with(polygons);
    EXPECT_THAT(refusal([&] { read_point_file(path); }), HasSubstr(message));
  }
  EXPECT_EQ(read_point_file(with("2 8\n3 0 1 2 3 0 2 3")).triangles.size(), 2u);
}

/// A few cells that go back would name all points each, as often as there are cells.
TEST_F(PointFile, CellsOfAFileDoNotGoBack) {
  std::string text = small_vtk;
  text.replace(text.find("3.0"), 3, "5.1");
  text.replace(text.find("1 5\n4 0 1 2 3"), 13, "4 4\nOFFSETS int\n0 4 0 4\nCONNECTIVITY int\n0 1 2 3");
  EXPECT_THAT(refusal([&] { read_point_file(file("a.vtk", text)); }),
              HasSubstr("a.vtk: cell 1 begins at the place 4 and ends at 0"));
}

/// A .vtp of one packed array that says of its blocks what `head` says.
std::string packed_vtp(const std::vector<std::uint64_t>& head, const std::string& blocks) {
  std::string text =
      "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"1\"><Points>"
      "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece>"
      "</PolyData><AppendedData encoding=\"raw\">_";
  text.append(reinterpret_cast<const char*>(head.data()), 8 * head.size());
  return text + blocks + "</AppendedData></VTKFile>";
}

TEST_F(PointFile, LengthsOfPackedBlocksFitTheFile) {
  const float ones[]{1, 1, 1};
  char block[64];
  uLongf size = sizeof block;
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(block), &size, reinterpret_cast<const Bytef*>(ones), sizeof ones), Z_OK);
  const auto read = [&](const std::vector<std::uint64_t>& head) {
    return read_point_file(file("a.vtp", packed_vtp(head, std::string(block, size))));
  };
  EXPECT_EQ(read({1, 12, 0, size}).vertices, (std::vector<Vec3d>{{1, 1, 1}}));
  // Two lengths whose sum in 64 bits is that of the block, one of them beyond its end; then others
  // that are too long.
  for (const std::vector<std::uint64_t>& head : {std::vector<std::uint64_t>{2, 12, 0, -4096ul, 4096 + size},
                                                 {2, 12, 0, size, -size},
                                                 {2, 12, 0, size, 100},
                                                 {1, 12, 0, 100},
                                                 {-3ul, 12, 0, size}})
    EXPECT_THAT(refusal([&] { read(head); }), HasSubstr("a.vtp: its array  is cut short"));
}

/// Hundreds of pieces that name the same appended bytes would be hundreds of times as many points.
TEST_F(PointFile, ArraysOfAFileAreNoMoreThanItsBytes) {
  const auto text = [](std::size_t pieces) {
    std::string out = "<VTKFile type=\"PolyData\"><PolyData>";
    for (std::size_t p = 0; p < pieces; ++p)
      out += "<Piece NumberOfPoints=\"10000\"><Points><DataArray type=\"Int8\" format=\"appended\"/></Points></Piece>";
    const std::uint32_t length = 30000;
    out += "</PolyData><AppendedData encoding=\"raw\">_";
    return out.append(reinterpret_cast<const char*>(&length), 4) + std::string(length, '\1') +
           "</AppendedData></VTKFile>";
  };
  EXPECT_EQ(read_point_file(file("a.vtp", text(2))).vertices.size(), 20000u);
  EXPECT_THAT(refusal([&] { read_point_file(file("a.vtp", text(300))); }), HasSubstr("hold more than the file can"));
}

/// Cut or changed anywhere, a file is refused or read, and nothing else.
TEST(PointText, AnyDamageIsAnErrorOrHarmless) {
  const std::pair<Model (*)(std::string_view, const std::string&), std::string> whole[]{
      {parse_bgeo, small_bgeo()}, {parse_vtk, small_vtk}, {parse_vtk_xml, small_vtp}};
  for (const auto& [parse, text] : whole)
    for (std::size_t at = 0; at < text.size(); ++at)
      for (const std::string& damaged : {text.substr(0, at), text.substr(0, at) + '\xff' + text.substr(at + 1),
                                         text.substr(0, at) + '9' + text.substr(at + 1)}) {
        try {
          EXPECT_LE(parse(damaged, "a").vertices.size(), 1000u);
        } catch (const InputError&) {
        }
      }
}

}  // namespace
