// glTF files, .gltf and .glb.
#include "dreampm/geometry/import.h"
#include "model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dreampm;
  const bool binary = fuzz::text_of(data, size).starts_with("glTF");
  const fuzz::InputFile file(data, size, binary ? ".glb" : ".gltf");
  fuzz::read_model_of(data, size, 2000, [&](std::string_view, const std::string&) { return read_model(file.path()); });
  return 0;
}
