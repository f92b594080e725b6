// glTF files, .gltf and .glb; of others that they name none is there.
#include "dreampm/import/gltf.h"

#include "model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dreampm;
  fuzz::read_model_of(data, size, 2000, [](std::string_view text, const std::string& name) {
    return parse_gltf(text, name, "no-such-folder");
  });
  return 0;
}
