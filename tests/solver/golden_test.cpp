// The bits of the step, frozen by instruction set: a change that is not meant to change the physics must not change
// them. After one that is meant to, copy the lines that this test prints into golden.txt and say in the CHANGELOG why.
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "dreampm/base/hash.h"
#include "mixed_world.h"

namespace dreampm {
namespace {
using namespace test;

std::map<std::string, std::string> golden_lines() {
  std::ifstream file(DM_SOURCE_DIR "/tests/solver/golden.txt");
  std::map<std::string, std::string> lines;
  std::string material, isa, hash;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    if (line.empty() || line[0] == '#' || !(words >> material >> isa >> hash)) continue;
    lines[material + " " + isa] = hash;
  }
  return lines;
}

TEST(Golden, EveryMaterialGivesTheFrozenBits) {
  const auto golden = golden_lines();
  std::string all;
  for (const MaterialInfo& m : material_infos())
    for (const std::string_view isa : cpu_instruction_sets()) {
      const auto cpu = make_cpu_backend(isa);
      Hash64 hash;
      hash.add(state_hash(ran<float>(m.name, *cpu, 100)));
      const std::string key = std::string(m.name) + " " + std::string(isa);
      all += key + " " + hash.hex() + "\n";
      const auto known = golden.find(key);
      EXPECT_EQ(hash.hex(), known == golden.end() ? "nothing" : known->second) << key;
    }
  if (HasFailure()) std::printf("the bits of this build:\n%s", all.c_str());
}

}  // namespace
}  // namespace dreampm
