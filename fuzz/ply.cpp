// PLY files: as meshes and clouds of others, and as the particles and surfaces of a run.
#include "dreampm/import/ply.h"

#include "dreampm/io/ply.h"
#include "model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dreampm;
  fuzz::read_model_of(data, size, 400, parse_ply);
  const fuzz::InputFile file(data, size, ".ply");
  // A file may be packed, to a thousandth at best.
  fuzz::read_one(size, 100000, [&] { read_particles(file.path()); });
  fuzz::read_one(size, 100000, [&] { read_mesh(file.path()); });
  fuzz::read_one(size, 100000, [&] { read_ply_shift(file.path()); });
  return 0;
}
