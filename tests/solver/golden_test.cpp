// The bits of the step, frozen by instruction set: a change that is not meant to change the physics
// must not change them. After one that is meant to, `tools/golden --update` writes golden.txt anew;
// say in the CHANGELOG why. A material that golden.txt does not name is reported, and fails
// nothing: it is frozen by the same command.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

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

/// Kernels, and the instruction set whose bits they must give.
struct Kernels {
  std::string isa;
  const KernelTable* table;
};
std::vector<Kernels> kernels_to_run() {
  std::vector<Kernels> all;
  const KernelTables here = available_kernels();
  for (int t = 0; t < here.count; ++t) {
    all.push_back({std::string(here.tables[t]->isa), here.tables[t]});
#ifdef DM_LANE_PAIRS
    if (all.back().isa == "avx2") all.push_back({"avx512", &pairs::kernel_table()});
#endif
  }
  return all;
}

TEST(Golden, EveryMaterialGivesTheFrozenBits) {
  auto golden = golden_lines();
  const auto listed = golden.size();
  std::string all, not_frozen;
  std::size_t frozen = 0;
  for (const auto& [isa, table] : kernels_to_run()) {
    int material = 0, built = 0;
    for (const MaterialInfo& m : material_infos()) {
      if (!table->kernels[material++]) continue;  // of pairs: there are not all
      ++built;
      Hash64 hash;
      hash.add(state_hash(ran<float>(m.name, *make_cpu_backend(*table), 100)));
      const std::string key = std::string(m.name) + " " + isa;
      all += key + " " + hash.hex() + "\n";
      const auto known = golden.find(key);
      if (known == golden.end()) {
        not_frozen += "  " + key + "\n";
        continue;
      }
      EXPECT_EQ(hash.hex(), known->second) << key << " by " << table->isa;
      ++frozen;
    }
    EXPECT_GE(built, 3) << table->isa;
  }
  EXPECT_GT(frozen, 0u) << "golden.txt lists " << listed << " lines, and none of them was run";
  if (!not_frozen.empty()) std::printf("NOT FROZEN, type tools/golden --update:\n%s", not_frozen.c_str());
  if (HasFailure() || !not_frozen.empty()) std::printf("the bits of this build:\n%s", all.c_str());
}

}  // namespace
}  // namespace dreampm
