// Several densities in one field: what lies densely is known by volume, and not by what the
// neighbors weigh.
#include <gtest/gtest.h>

#include "dreampm/base/parallel.h"
#include "dreampm/state/volume_relaxation.h"
#include "worlds.h"

namespace dreampm::mixture_test {
namespace {
using namespace test;

constexpr double dx = 0.02, spacing = dx / 2;

struct Matter {
  std::string_view material;
  double density;
};

Values with_density(const Matter& m) {
  Values v = values_of(m.material, {{"density", m.density}});
  if (find_material(m.material)->find("bulk_modulus")) v.set("bulk_modulus", 1e5);
  return v;
}

/// A box full of layers, the first one lowest, each as thick.
template <class R>
World<R> full_box(const std::vector<Matter>& layers, std::vector<std::vector<ParticleSeed>>& seeds) {
  constexpr int thick = 4;
  World<R> w = empty_world<R>(dx, {8, thick * static_cast<int>(layers.size()), 8}, WallType::slip);
  w.settings.fixed_dt = 2e-4;
  seeds.clear();
  std::uint32_t first = 0;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    add_set(w, layers[l].material, with_density(layers[l]), spacing);
    const double low = static_cast<double>(l) * thick * dx;
    seeds.push_back(lattice({{0, low, 0}, {8 * dx, low + thick * dx, 8 * dx}}, spacing, still(), first));
    first += static_cast<std::uint32_t>(seeds.back().size());
  }
  return w;
}

// If the grid knew masses alone, the light layer would read as too dense and the heavy one as too
// loose, and both would press or part until they moved.
TEST(Mixture, LiquidsOfDifferentDensitiesLieStill) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<double> w = full_box<double>({{"newtonian", 1000}, {"newtonian", 100}}, seeds);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, seeds);
  while (w.step < 200) step<double>(w, *backend, nullptr);
  EXPECT_GT(volume_relaxation_time(w, 1.0), 0) << "or nothing would be measured";
  const auto x = positions_by_id(w);
  double moved = 0;
  for (const auto& set : seeds)
    for (const ParticleSeed& n : set) moved = std::max(moved, length(x[n.id] - n.position) / dx);
  EXPECT_LT(moved, 1e-9);
}

// Volumes give the same result as masses for densities that differ by next to nothing, in a flow
// that shears and parts.
TEST(Mixture, VolumesTellWhatMassesDoOfOneDensity) {
  for (const std::string_view material : {"newtonian", "sand", "viscoplastic"}) {
    const auto flown = [&](double density) {
      std::vector<std::vector<ParticleSeed>> seeds;
      World<double> w = full_box<double>({{material, 1000}, {material, density}}, seeds);
      w.high.x = 12;
      w.gravity = {4, -9.81, 0};
      EXPECT_EQ(w.measures_by_volume(0), density != 1000);
      const auto backend = make_reference_backend<double>();
      begin(w, *backend, seeds);
      while (w.step < 150) step<double>(w, *backend, nullptr);
      return positions_by_id(w);
    };
    const auto by_mass = flown(1000), by_volume = flown(1000 * (1 + 1e-12));
    double apart = 0;
    for (std::size_t i = 0; i < by_mass.size(); ++i) apart = std::max(apart, length(by_mass[i] - by_volume[i]) / dx);
    std::printf("%s: %.2e cells\n", std::string(material).c_str(), apart);
    EXPECT_LT(apart, 1e-6) << material;
  }
}

TEST(Mixture, WhereAllIsOfOneDensityMassTellsIt) {
  std::vector<std::vector<ParticleSeed>> seeds;
  EXPECT_FALSE(full_box<float>({{"newtonian", 1000}, {"newtonian", 1000}}, seeds).measures_by_volume(0));
  EXPECT_FALSE(full_box<float>({{"elastic", 1000}, {"elastic", 100}}, seeds).measures_by_volume(0))
      << "nobody asks there";
  const auto apart = full_box<float>({{"newtonian", 1000}, {"sand", 1600}}, seeds);
  EXPECT_FALSE(apart.measures_by_volume(0) || apart.measures_by_volume(1)) << "liquids have a field of their own";
}

/// Two liquids, sand and jelly, thrown together: both fields hold several densities.
World<float> thrown_together(std::vector<std::vector<ParticleSeed>>& seeds) {
  World<float> w = full_box<float>({{"sand", 1600}, {"newtonian", 1000}, {"elastic", 400}, {"newtonian", 200}}, seeds);
  w.high.x = 12;
  w.gravity = {3, -9.81, 0};
  for (std::size_t s = 0; s < seeds.size(); ++s)
    for (ParticleSeed& n : seeds[s]) n.velocity = {s % 2 ? -0.5 : 0.5, 0, 0.2};
  return w;
}

TEST(Mixture, CpuFollowsTheReferenceOnAnyNumberOfThreads) {
  std::vector<std::vector<ParticleSeed>> seeds;
  const World<float> born = thrown_together(seeds);
  ASSERT_TRUE(born.measures_by_volume(0) && born.measures_by_volume(1));
  const auto after = [&](Backend<float>& backend) {
    World<float> w = born;
    begin(w, backend, seeds);
    while (w.step < 200) step<float>(w, backend, nullptr);
    return w;
  };
  const auto want = positions_by_id(after(*make_reference_backend<float>()));
  for (const std::string_view isa : cpu_instruction_sets()) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 3}) {
      const ThreadLimit limit(threads);
      const World<float> w = after(*make_cpu_backend(isa));
      hashes.push_back(state_hash(w));
      const auto got = positions_by_id(w);
      double sum = 0;
      for (std::size_t i = 0; i < want.size(); ++i) sum += length2(got[i] - want[i]) / (dx * dx);
      EXPECT_LE(std::sqrt(sum / static_cast<double>(want.size())), 1e-5) << isa;
    }
    EXPECT_EQ(hashes[0], hashes[1]) << isa;
  }
}

}  // namespace
}  // namespace dreampm::mixture_test
