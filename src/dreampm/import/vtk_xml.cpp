// The layout is that of "VTK XML Formats"
// (https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html).
#include "dreampm/import/vtk_xml.h"

#include <cstring>
#include <map>

#include "dreampm/base/error.h"
#include "dreampm/import/point_arrays.h"
#include "dreampm/import/vtk_cells.h"
#include "dreampm/import/vtk_xml_data.h"

namespace dreampm {
namespace {

/// The text without appended data, whose raw bytes are no XML.
struct Split {
  std::string xml;
  std::string_view appended;
  bool raw = false;
  std::size_t bytes = 0;  ///< of the file
};

Split split(std::string_view text, const std::string& name) {
  const std::size_t at = text.find("<AppendedData");
  if (at == text.npos) return {std::string(text), {}, false, text.size()};
  const std::size_t end = text.find('>', at), first = text.find('_', end);
  if (end == text.npos || first == text.npos) fail_input("{}: its AppendedData are cut short", name);
  const bool raw = text.substr(at, end - at).find("\"raw\"") != text.npos;
  return {std::string(text.substr(0, at)) + "</VTKFile>", text.substr(first + 1), raw, text.size()};
}

class XmlFile {
 public:
  XmlFile(std::string_view text, const std::string& name) : name_(name), parts_(split(text, name)) {
    const pugi::xml_parse_result parsed = document_.load_buffer(parts_.xml.data(), parts_.xml.size());
    if (!parsed) fail_input("{}: is no XML: {} at byte {}", name, parsed.description(), parsed.offset);
    root_ = document_.child("VTKFile");
    if (!root_) fail_input("{}: has no element VTKFile", name);
  }

  Model read() {
    const std::string type = root_.attribute("type").value();
    if (type != "PolyData" && type != "UnstructuredGrid")
      fail_input("{}: holds {}; PolyData and UnstructuredGrid are read", name_, type.empty() ? "nothing known" : type);
    VtkXmlData data(root_, parts_.bytes, parts_.appended, parts_.raw, name_);
    for (const pugi::xml_node& piece : root_.child(type.c_str()).children("Piece")) read_piece(piece, data);
    if (model_.vertices.empty()) fail_input("{}: holds no points", name_);
    require_finite(model_, name_);
    add_vtk_cells(model_, cells_, name_);
    for (const auto& [name, array] : arrays_) take_point_array(model_, array, name_);
    return std::move(model_);
  }

 private:
  void read_piece(const pugi::xml_node& piece, VtkXmlData& data) {
    const std::size_t first = model_.vertices.size(), n = piece.attribute("NumberOfPoints").as_ullong();
    if (n == 0) return;
    const std::vector<double> x = data.values(piece.child("Points").child("DataArray"));
    if (x.size() / 3 != n || x.size() % 3 != 0) fail_input("{}: has {} coordinates for {} points", name_, x.size(), n);
    for (std::size_t i = 0; i < x.size(); i += 3) model_.vertices.push_back({x[i], x[i + 1], x[i + 2]});
    for (const pugi::xml_node& array : piece.child("PointData").children("DataArray")) {
      const std::string name = array.attribute("Name").value();
      const std::size_t columns = array.attribute("NumberOfComponents").as_uint(1);
      if (!is_point_array(name, columns)) continue;
      PointArray& out = arrays_[name];
      const std::vector<double> values = data.values(array);
      out.name = name;
      out.columns = columns;
      out.bytes = std::strcmp(array.attribute("type").value(), "UInt8") == 0;
      out.values.insert(out.values.end(), values.begin(), values.end());
    }
    for (const auto& [element, kind] :
         {std::pair("Polys", "polygons"), {"Strips", "triangle_strips"}, {"Cells", "cells"}})
      if (const pugi::xml_node of = piece.child(element)) read_cells(of, kind, static_cast<double>(first), data);
  }

  void read_cells(const pugi::xml_node& element, const char* kind, double first, VtkXmlData& data) {
    VtkCells cells{kind, {}, {0}, {}};
    for (const pugi::xml_node& array : element.children("DataArray")) {
      const std::string name = array.attribute("Name").value();
      const std::vector<double> values = data.values(array);
      if (name == "connectivity")
        for (const double v : values) cells.connectivity.push_back(v + first);
      else if (name == "offsets")
        cells.offsets.insert(cells.offsets.end(), values.begin(), values.end());
      else if (name == "types")
        cells.types = values;
    }
    cells_.push_back(std::move(cells));
  }

  const std::string& name_;
  Split parts_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  Model model_;
  std::map<std::string, PointArray> arrays_;
  std::vector<VtkCells> cells_;
};

}  // namespace

Model parse_vtk_xml(std::string_view text, const std::string& name) { return XmlFile(text, name).read(); }

}  // namespace dreampm
