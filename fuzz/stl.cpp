// STL files.
#include "dreampm/import/stl.h"

#include "model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dreampm::fuzz::read_model_of(data, size, 200, dreampm::parse_stl);
  return 0;
}
