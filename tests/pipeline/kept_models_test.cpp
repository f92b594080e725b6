// A run's folder keeps its models with every file that they name.
#include "dreampm/pipeline/models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/import/import.h"
#include "dreampm/scene/files.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

class KeptModels : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(DM_BINARY_DIR) / "test-files" / "kept_models" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    make_folder(folder_ / "mine");
    make_folder(folder_ / "run");
  }
  /// A tetrahedron whose only buffer lies at `uri`.
  static std::string gltf_at(const std::string& uri) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
{"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"uri": ")" +
           uri + R"(", "byteLength": 72}]})";
  }
  static std::string buffer(float size = 1) {
    const float corners[] = {0, 0, 0, size, 0, 0, 0, 1, 0, 0, 0, 1};
    return std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
           std::string("\0\0\2\0\1\0\0\0\1\0\3\0\1\0\2\0\3\0\2\0\0\0\3\0", 24);
  }
  void write(const std::string& name, const std::string& text) const {
    make_folder((folder_ / "mine" / name).parent_path());
    replace_file_text(folder_ / "mine" / name, text);
  }
  void write_packed(const std::string& name, const std::string& text) const {
    const gzFile file = gzopen((folder_ / "mine" / name).c_str(), "wb");
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(gzwrite(file, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
    EXPECT_EQ(gzclose(file), Z_OK);
  }
  /// Keeps a scene with this model in run/, and gives the path of the copy there.
  fs::path keep(const std::string& name) const {
    const auto parsed = scene::parse_scene_text(
        "dreampm: 1\nname: one\nspace: {min: [-1, -1, -1], max: [1, 1, 1], spacing: 0.1}\n"
        "time: {fps: 10, frames: 1}\nmaterials: {jelly: {type: elastic}}\nbodies: {it: {material: jelly, shape: "
        "{mesh: " +
            (folder_ / "mine" / name).string() + "}}}\n",
        "one.yaml");
    EXPECT_TRUE(parsed.ok()) << parsed.text();
    write_run_scene(parsed.scene, folder_ / "run");
    fs::path copy;
    auto kept = located_in(with_kept_models(parsed.scene), folder_ / "run");
    scene::each_model(kept, [&](std::string& path) { copy = path; });
    return copy;
  }
  void expect_kept(const std::string& name) const {
    const fs::path copy = keep(name);
    fs::rename(folder_ / "mine", folder_ / "gone");
    EXPECT_EQ(read_model(copy).triangles.size(), 4u) << name;
    fs::rename(folder_ / "gone", folder_ / "mine");
  }
  fs::path folder_;
};

TEST_F(KeptModels, BuffersThatAreWrittenAsUris) {
  write("my file.bin", buffer());
  write("escaped.gltf", gltf_at("my%20file.bin"));
  expect_kept("escaped.gltf");
  write("100%25.bin", buffer());
  write("as_written.gltf", gltf_at("100%25.bin"));
  expect_kept("as_written.gltf");
}

TEST_F(KeptModels, BuffersOfPackedModels) {
  write("data/t.bin", buffer());
  for (const char* name : {"t.gltf.gz", "T.GLTF.GZ"}) {
    write_packed(name, gltf_at("data/t.bin"));
    expect_kept(name);
  }
  const std::string before = scene::model_hash(folder_ / "mine/t.gltf.gz");
  write("data/t.bin", buffer(0.5));
  EXPECT_NE(scene::model_hash(folder_ / "mine/t.gltf.gz"), before) << "another buffer is another model";
}

TEST_F(KeptModels, NothingIsCopiedOutsideOfTheModelsFolder) {
  write("sub/other.bin", "");
  write("t.bin", buffer());
  write("inside.gltf", gltf_at("sub/../t.bin"));
  expect_kept("inside.gltf");
  replace_file_text(folder_ / "x.bin", buffer());
  for (const char* uri : {"../x.bin", "sub/../../x.bin", "sub/%2E%2E/../x.bin"}) {
    write("outside.gltf", gltf_at(uri));
    const fs::path copy = keep("outside.gltf");
    EXPECT_TRUE(fs::exists(copy));
    EXPECT_FALSE(fs::exists(folder_ / "run/models/x.bin")) << uri;
  }
}

}  // namespace
}  // namespace dreampm
