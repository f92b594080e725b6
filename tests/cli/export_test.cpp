// dreampm export: what is typed, what comes, what is refused. Other programs read the files back in
// tests/python/test_export.py.
#include <gmock/gmock.h>

#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class Export : public TypingAtADam {
 protected:
  void SetUp() override {
    TypingAtADam::SetUp();
    ASSERT_EQ(type("run dam.yaml").code, 0);
  }
  std::size_t files_in(const std::string& name) const {
    std::size_t n = 0;
    if (fs::exists(folder / name))
      for (const auto& e : fs::recursive_directory_iterator(folder / name)) n += e.is_regular_file();
    return n;
  }
};

TEST_F(Export, TakesWhatThereIs) {
  Typed t = type("export out/dam --to ply");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, "out/dam/export/ply\n");
  EXPECT_THAT(t.err, HasSubstr("particles alone: out/dam: the surface of frame 1 is missing"));
  EXPECT_EQ(files_in("out/dam/export/ply"), 3u);
  EXPECT_EQ(type("surface out/dam").code, 0);
  for (const auto& [to, files] : std::map<std::string, std::size_t>{{"obj", 6}, {"gltf", 3}, {"vdb", 3}}) {
    t = type("export out/dam --to " + to + " --out " + to);
    EXPECT_EQ(t.code, 0) << t.err;
    EXPECT_EQ(t.out, to + "\n");
    EXPECT_EQ(files_in(to), files) << to;
  }
  t = type("export out/dam --to vtkhdf --frames 2:3");
  EXPECT_EQ(t.out, "out/dam/export/dam-particles.vtkhdf\nout/dam/export/dam-surface.vtkhdf\n") << t.err;
  t = type("export out/dam --to usd --what surface --frames 2 --out dam.usda");
  EXPECT_EQ(t.out, "dam.usda\n") << t.err;
  EXPECT_THAT(t.err, HasSubstr("export: frame 1/1"));
  const std::string usd = read_file(folder / "dam.usda");
  EXPECT_THAT(usd, HasSubstr("startTimeCode = 2\n    endTimeCode = 2\n    timeCodesPerSecond = 24\n"));
  EXPECT_THAT(usd, testing::Not(HasSubstr("def Points")));
}

TEST_F(Export, RefusesWhatCannotBe) {
  const std::pair<const char*, const char*> refused[]{
      {"export out/dam", "--to is required"},
      {"export out/dam --to fbx", "--to: fbx not in {"},
      {"export out/dam --to alembic",
       "Alembic files are written by the package of Python: pip install alembic3d, then"},
      {"export out/none --to ply", "out/none: no such folder; dreampm run SCENE makes one"},
      {"export out/dam --to ply --what surface", "the surface of frame 1 is missing; dreampm surface out/dam makes it"},
      {"export out/dam --to gltf --up z", "in gltf Y is up by definition"},
      {"export out/dam --to ply --up x", "--up: x not in {"},
      {"export out/dam --to ply --scale 0", "--scale: 0 is no number from 1e-06 to 1000000"},
      {"export out/dam --to ply --scale nan", "--scale: nan is no number"},
      {"export out/dam --to ply --frames 2:9", "out/dam: frame 4 is not simulated; it has 3 frames"},
      {"export out/dam --to ply --frames 3:2", "--frames is 3:2: the last frame lies before the first"},
      {"export out/dam --to usd --out dam.usdc", "dam.usdc: a file of --to usd ends with .usda; usdcat"},
      {"export out/dam --to vtkhdf --out dam.vtu", "dam.vtu: a file of --to vtkhdf ends with .vtkhdf"},
      {"export out/dam --to usd --out no/dam.usda", "no/dam.usda: cannot be written: there is no folder no"},
      {"export out/dam --to ply --out dam.yaml", "dam.yaml: cannot make this folder"}};
  for (const auto& [line, words] : refused) expect_refused(line, words);
  EXPECT_EQ(files_in("out/dam/export"), 0u);
  EXPECT_EQ(files_in("no"), 0u);
}

TEST_F(Export, ADamagedFrameLeavesNoFile) {
  replace_file_text(folder / "out/dam/particles/particles_000003.ply", "ply\n");
  for (const char* to : {"usd", "vtkhdf"}) {
    const Typed t = type(std::string("export out/dam --to ") + to);
    EXPECT_EQ(t.code, 2) << t.err;
    EXPECT_THAT(t.err, HasSubstr("particles_000003.ply"));
  }
  EXPECT_EQ(files_in("out/dam/export"), 0u);
}

TEST_F(Export, AllPlacesCountFromWhereTheRunSays) {
  const fs::path file = folder / "out/dam/particles/particles_000002.ply";
  std::string text = read_file(file);
  replace_file_text(file, text.insert(text.find("element"), "comment shift 1 0 0\n"));
  expect_refused("export out/dam --to usd",
                 "particles_000002.ply: its places count from (1, 0, 0), those of the run from (0, 0, 0)");
  EXPECT_EQ(files_in("out/dam/export"), 0u);
}

TEST_F(Export, AFullDiskLeavesNoFile) {
  for (const char* to : {"usd", "vtkhdf"}) {
    const Typed t = type(std::string("export out/dam --to ") + to, "ulimit -f 40");
    EXPECT_EQ(t.code, 1) << to << t.err;
    EXPECT_THAT(t.err, HasSubstr("cannot be written: File too large")) << to;
    EXPECT_EQ(files_in("out/dam/export"), 0u) << to;
  }
  // A volume is smaller than that, up to the size at which it is whole.
  ASSERT_EQ(type("export out/dam --to vdb --frames 1 --out whole").code, 0);
  const auto bytes = fs::file_size(folder / "whole/dam_000001.vdb");
  ASSERT_GT(bytes, 1024u);
  for (const std::size_t blocks : {std::size_t(1), (bytes - 1) / 512}) {
    const Typed t = type("export out/dam --to vdb --frames 1 --out cut", fmt::format("ulimit -f {}", blocks));
    EXPECT_EQ(t.code, 1) << blocks << t.err;
    EXPECT_THAT(t.err, HasSubstr("cut/dam_000001.vdb: cannot be written: File too large")) << blocks;
    EXPECT_EQ(files_in("cut"), 0u) << blocks;
  }
}

}  // namespace
}  // namespace dreampm::test
