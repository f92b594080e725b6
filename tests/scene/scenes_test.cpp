// Every scene of scenes/ parses, with each of its variants, and comes to the size that its comments
// promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "dreampm/physics/materials.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"

namespace dreampm::scene {
namespace {

namespace fs = std::filesystem;

/// Particles of analytic bodies; a mesh counts as nothing.
double particles(const model::Scene& s) {
  double volume = 0;
  for (const model::Body& b : s.bodies) {
    if (const BoxShape* box = std::get_if<BoxShape>(&b.shape.form)) volume += box->size.x * box->size.y * box->size.z;
    if (const SphereShape* ball = std::get_if<SphereShape>(&b.shape.form))
      volume += 4.0 / 3 * 3.14159265358979 * std::pow(ball->radius, 3);
    if (const CylinderShape* c = std::get_if<CylinderShape>(&b.shape.form))
      volume += 3.14159265358979 * c->radius * c->radius * c->height;
  }
  return volume / std::pow(s.space.spacing, 3);
}

TEST(Scenes, AllParseInEveryVariant) {
  int count = 0;
  for (const auto& file : fs::directory_iterator(fs::path(DM_SOURCE_DIR) / "scenes")) {
    if (file.path().extension() != ".yaml") continue;
    ++count;
    const ParseResult full = parse_scene(file.path());
    ASSERT_TRUE(full.problems.empty()) << full.text();
    EXPECT_EQ(full.scene.name, file.path().stem());
    ASSERT_NE(std::find(full.variants.begin(), full.variants.end(), "preview"), full.variants.end()) << file.path();
    for (const std::string& v : full.variants) {
      const ParseResult r = parse_scene(file.path(), {.variant = v, .overrides = {}});
      ASSERT_TRUE(r.problems.empty()) << r.text();
      EXPECT_GT(r.scene.space.spacing, full.scene.space.spacing) << v;
      EXPECT_NE(r.scene.output.folder, full.scene.output.folder) << v << " would overwrite the full run";
      EXPECT_NE(scene_hash(r.scene, Part::simulation), scene_hash(full.scene, Part::simulation));
      EXPECT_LT(particles(r.scene), 60000) << v;
    }
  }
  EXPECT_GE(count, 8);
}

TEST(Scenes, TheDragonIsTheOneOfTheReport) {
  const ParseResult r = parse_scene(fs::path(DM_SOURCE_DIR) / "scenes/dragon-splatting.yaml");
  ASSERT_TRUE(r.ok()) << r.text();
  EXPECT_EQ(r.scene.space.spacing, 0.003);
  EXPECT_DOUBLE_EQ(r.scene.space.dx(), 0.006);
  EXPECT_EQ(r.scene.time.frames, 120);
  EXPECT_EQ(r.scene.space.cells(), (Vec3i{167, 200, 100}));
  EXPECT_NEAR(r.scene.space.end().x, 1.002, 1e-12);
  const MeshShape& mesh = std::get<MeshShape>(r.scene.bodies.at(0).shape.form);
  EXPECT_EQ(mesh.path, "asset:stanford-dragon");
  EXPECT_EQ(mesh.longest, 0.8);
}

TEST(Scenes, TheDropHasAVariantForEveryPreset) {
  // The pictures of docs/reference/materials.md: TYPE-PRESET, or TYPE where there are no presets.
  const fs::path file = fs::path(DM_SOURCE_DIR) / "scenes/materials/drop.yaml";
  std::size_t wanted = 0;
  const auto has = [&](const MaterialInfo& info, const Preset* preset) {
    const std::string name = std::string(info.name) + (preset ? "-" + std::string(preset->name) : "");
    const ParseResult r = parse_scene(file, {.variant = name, .overrides = {}});
    ++wanted;
    ASSERT_TRUE(r.ok()) << r.text();
    const model::Material& m = r.scene.materials.at(0);
    EXPECT_EQ(m.type, info.name) << name;
    // A picture may take a softer or slower relative of the preset, but of its density.
    for (const Preset::Value& v : preset ? preset->values : std::span<const Preset::Value>{})
      if (v.key == "density") {
        EXPECT_EQ(m.values["density"], v.value) << name;
      }
    EXPECT_LT(particles(r.scene), 70000) << name;
  };
  OwnMaterials::for_each([&]<class M>() {
    for (const Preset& p : M::info.presets) has(M::info, &p);
    if (M::info.presets.empty()) has(M::info, nullptr);
  });
  EXPECT_EQ(parse_scene(file).variants.size(), wanted);
}

}  // namespace
}  // namespace dreampm::scene
