#include "dreampm/import/asset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "dreampm/geometry/winding_number.h"
#include "geometry/meshes.h"

using namespace dreampm;

namespace {

class Asset : public InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    ::setenv("DREAMPM_CACHE", folder.c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("DREAMPM_CACHE");
    InFolder::TearDown();
  }
};

/// How many faces go along each edge, from the first vertex to the second.
using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;
Edges edges_of(const Model& model) {
  Edges edges;
  for (const auto& [a, b, c] : model.triangles)
    for (const auto& e : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) ++edges[e];
  return edges;
}
/// True if each edge has one face on either side.
bool is_closed(const Edges& edges) {
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto& [e, n] = edge;
    return n == 1 && edges.contains({e.second, e.first});
  });
}

TEST_F(Asset, KnotIsClosedAndLooksOutward) {
  const Model knot = load_asset("asset:knot");
  const Edges edges = edges_of(knot);
  EXPECT_TRUE(is_closed(edges));
  // twists nowhere: no edge is longer than the mesh is fine
  for (const auto& [e, n] : edges) ASSERT_LT(length(knot.vertices[e.first] - knot.vertices[e.second]), 0.11);
  const WindingNumber winding(about(knot, {}));
  EXPECT_NEAR(winding({1.45, 0, 0}), 1, 0.01);  // on the curve
  EXPECT_NEAR(winding({0, 0, 0}), 0, 0.01);     // in the eye
}

// Needs no file; each edge has a face on either side, and all faces look outward.
TEST_F(Asset, TheLittleDragonIsClosedAndStands) {
  const Model dragon = load_asset("asset:dragon");
  EXPECT_TRUE(is_closed(edges_of(dragon)));
  EXPECT_GT(dragon.triangles.size(), 5000u);
  EXPECT_LT(dragon.triangles.size(), 12000u);
  const Box3d box = bounds_of(dragon);
  EXPECT_NEAR(box.min.y, 0, 0.02);
  EXPECT_NEAR(box.min.z, -box.max.z, 0.04);
  const WindingNumber winding(about(dragon, {}));
  for (const Vec3d& in : {Vec3d{0.1, 0.6, 0}, Vec3d{1.1, 1.6, 0}, Vec3d{0.5, 0.1, 0.34}, Vec3d{-0.9, 0.22, 0.2}})
    EXPECT_NEAR(winding(in), 1, 0.01);
  for (const Vec3d& out : {Vec3d{0.5, 0.2, 0}, Vec3d{1.2, 0.8, 0}, Vec3d{-0.5, 1.3, 0}})
    EXPECT_NEAR(winding(out), 0, 0.01);
  EXPECT_NEAR(enclosed_volume(dragon), 1.65, 0.1);
}

TEST_F(Asset, MissingDragonSaysHowToGetIt) {
  const std::string text = refusal([] { load_asset("asset:stanford-dragon"); });
  for (const char* part : {"dragon_vrip.ply.gz", "tools/fetch_dragon", "make demo", "--model FILE", "asset:knot"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_NE(text.find(folder.string()), std::string::npos) << text;
}

TEST_F(Asset, WrongDragonIsRefused) {
  file("dragon_vrip.ply.gz", "ply\n");
  EXPECT_NE(refusal([] { load_asset("asset:stanford-dragon"); }).find("SHA-256"), std::string::npos);
  file("dragon_vrip_res2.ply.gz", "\x1f\x8b\x08");
  EXPECT_NE(refusal([] { load_asset("asset:stanford-dragon-res2"); }).find("cut short"), std::string::npos);
}

TEST_F(Asset, ShaIsThatOfTheStandard) {
  // FIPS 180's vector for "abc" must be what the message says
  file("dragon_vrip.ply.gz", "abc");
  EXPECT_NE(refusal([] {
              load_asset("asset:stanford-dragon");
            }).find("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"),
            std::string::npos);
}

TEST_F(Asset, UnknownNamesAreToldTheKnown) {
  const std::string text = refusal([] { load_asset("asset:bunny"); });
  for (const std::string& name : asset_names()) EXPECT_NE(text.find("asset:" + name), std::string::npos) << text;
}

TEST_F(Asset, FolderFollowsTheEnvironment) {
  EXPECT_EQ(asset_folder(), folder);
  ::unsetenv("DREAMPM_CACHE");
  ::setenv("XDG_CACHE_HOME", "/x", 1);
  EXPECT_EQ(asset_folder(), "/x/dreampm");
  ::unsetenv("XDG_CACHE_HOME");
  ::setenv("HOME", "/h", 1);
  EXPECT_EQ(asset_folder(), "/h/.cache/dreampm");
}

}  // namespace
