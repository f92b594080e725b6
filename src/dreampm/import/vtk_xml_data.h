// The numbers of a DataArray of VTK's XML files, however they are written.
#pragma once
#include <pugixml.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace dreampm {

class VtkXmlData {
 public:
  /// `file`: the element VTKFile, of a file of that many bytes; `appended`: what follows the
  /// character _ of its AppendedData. Throws InputError for a packing that is not read.
  VtkXmlData(const pugi::xml_node& file, std::size_t file_bytes, std::string_view appended, bool raw, std::string name);

  /// The values of one DataArray. Throws InputError naming file and array: also where many arrays
  /// name the same bytes, so that all of them are more than a file of its size can hold.
  std::vector<double> values(const pugi::xml_node& array);

 private:
  std::vector<double> read(const pugi::xml_node& array, const std::string& what) const;
  std::vector<double> inline_text(const pugi::xml_node& array, const std::string& what) const;
  std::string bytes(std::string_view from, bool base64, const std::string& what) const;
  std::string packed(std::string_view from, bool base64, const std::string& what) const;
  std::size_t length(std::string_view header, std::size_t number, const std::string& what) const;
  std::string_view appended_;
  bool raw_, swapped_, wide_, zlib_;
  std::size_t left_;  ///< values that may still come
  std::string name_;
};

}  // namespace dreampm
