// VTK files: legacy ones by their first words, others as XML, in which packed data grow by a
// thousand and become doubles.
#include "dreampm/import/vtk_legacy.h"
#include "dreampm/import/vtk_xml.h"
#include "model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dreampm;
  if (fuzz::text_of(data, size).starts_with("# vtk"))
    fuzz::read_model_of(data, size, 200, parse_vtk);
  else
    fuzz::read_model_of(data, size, 20000, parse_vtk_xml);
  return 0;
}
