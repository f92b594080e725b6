// The bits of the step, frozen by instruction set: a change that is not meant to change the physics must not change
// them. After one that is meant to, copy the lines that this test prints into golden.txt and say in the CHANGELOG why.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/base/hash.h"
#include "mixed_world.h"

namespace dreampm {
namespace pairs {
const KernelTable& kernel_table();  // tests/physics/lane_pairs.h
}
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

std::string hash_of(const MaterialInfo& material, Backend<float>& cpu) {
  Hash64 hash;
  hash.add(state_hash(ran<float>(material.name, cpu, 100)));
  return hash.hex();
}

TEST(Golden, EveryMaterialGivesTheFrozenBits) {
  const auto golden = golden_lines();
  std::string all;
  for (const MaterialInfo& m : material_infos())
    for (const std::string_view isa : cpu_instruction_sets()) {
      const std::string hash = hash_of(m, *make_cpu_backend(isa));
      const std::string key = std::string(m.name) + " " + std::string(isa);
      all += key + " " + hash + "\n";
      const auto known = golden.find(key);
      EXPECT_EQ(hash, known == golden.end() ? "nothing" : known->second) << key;
    }
  if (HasFailure()) std::printf("the bits of this build:\n%s", all.c_str());
}

#ifdef DM_LANE_PAIRS
TEST(Golden, SixteenLanesInPairsGiveTheBitsOfAvx512) {
  const std::vector<std::string_view> here = cpu_instruction_sets();
  if (std::find(here.begin(), here.end(), "avx2") == here.end()) GTEST_SKIP() << "this machine has no AVX2";
  ASSERT_EQ(pairs::kernel_table().lanes, 16);
  auto golden = golden_lines();
  for (const std::string name : {"newtonian", "elastic", "snow"})
    EXPECT_EQ(hash_of(*find_material(name), *make_cpu_backend(pairs::kernel_table())), golden[name + " avx512"])
        << name;
}
#endif

}  // namespace
}  // namespace dreampm
