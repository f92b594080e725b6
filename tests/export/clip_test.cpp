// What all formats have in common: axes, and files that are whole or absent.
#include "dreampm/export/clip.h"

#include <gmock/gmock.h>

#include "clips.h"
#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/math/mat3.h"

namespace dreampm::test {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Clips = InOwnFolder;

TEST(Axes, TurnADeformationWithItsPlace) {
  ParticleFrame frame;
  frame.position = {{1, 2, 3}};
  for (int k = 0; k < 9; ++k) frame.columns["f_" + std::to_string(k / 3) + std::to_string(k % 3)] = {float(k + 1)};
  Axes{Up::z, 10}.apply(frame);
  EXPECT_EQ(frame.position[0], (Vec3f{10, -30, 20}));
  // F dx of a turned dx is the turned F dx.
  const Vec3f dx{0.5f, -1, 2}, image{1 * 0.5f - 2 + 6, 4 * 0.5f - 5 + 12, 7 * 0.5f - 8 + 18};
  const Axes turn{Up::z, 1};
  const Vec3f d = turn.turned(dx);
  Vec3f found;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) found[i] += frame.columns["f_" + std::to_string(i) + std::to_string(j)][0] * d[j];
  EXPECT_EQ(found, turn.turned(image));
}

TEST(Axes, TurnBackToWhatWasTurned) {
  for (const Up up : {Up::y, Up::z}) {
    const Axes axes{up, 1};
    EXPECT_EQ(axes.turned_back(axes.turned(Vec3d{1, 2, 3})), (Vec3d{1, 2, 3}));
  }
}

/// A file of all frames is there when it is whole, and leaves nothing where it never becomes so.
TEST_F(Clips, AFileOfAllFramesIsWholeOrAbsent) {
  const ClipInfo clip = clip_of_two();
  for (const Format& format : formats()) {
    if (!format.one_file()) continue;
    const auto target = folder / (std::string("clip") + format.extension);
    for (const auto& file : format.files(clip, target)) replace_file_text(file, "before");
    {
      const auto writer = format.writer(clip, target);
      writer->add(frame_of_two(1));
    }
    for (const auto& file : format.files(clip, target)) EXPECT_EQ(read_file(file), "before") << format.name;
    for (const std::string& name : files()) EXPECT_THAT(name, testing::Not(HasSubstr(".part"))) << format.name;
    const auto writer = format.writer(clip, target);
    for (const int n : {1, 2}) writer->add(frame_of_two(n));
    writer->finish();
    for (const auto& file : format.files(clip, target)) EXPECT_GT(std::filesystem::file_size(file), 1000u);
  }
  EXPECT_THAT(files(), ElementsAre("clip-particles.vtkhdf", "clip-surface.vtkhdf", "clip.usda"));
}

TEST_F(Clips, FramesWithoutMatterAreFrames) {
  const ClipInfo clip = clip_of_two();
  ClipFrame empty;
  empty.particles.material_names = {"water", "sand"};
  empty.meshes.resize(1);
  for (const Format& format : formats()) {
    const auto target = format.one_file() ? folder / (std::string("empty") + format.extension) : folder;
    const auto writer = format.writer(clip, target);
    writer->add(empty);
    ClipFrame next = frame_of_two(2);
    next.particles.color.assign(next.particles.size(), {255, 0, 0, 255});
    next.colors.assign(next.particles.size(), {1, 0, 0});
    writer->add(next);
    writer->finish();
  }
  EXPECT_EQ(files().size(), 3u + 2 * (2 + 2 + 1 + 1));
}

TEST_F(Clips, AFarPlaceIsATransformWhereTheFormatHasOne) {
  ClipInfo clip = clip_of_two();
  ClipFrame far = frame_of_two(1);
  clip.shift = far.particles.shift = {500000.25, 0, 0};
  writer_of("gltf", clip, folder)->add(far);
  EXPECT_THAT(read_file(folder / "small_000001.glb"), HasSubstr("\"translation\":[500000.25,0.0,0.0]"));
  const auto usd = writer_of("usd", clip, folder / "far.usda");
  usd->add(far), usd->finish();
  EXPECT_THAT(read_file(folder / "far.usda"), HasSubstr("double3 xformOp:translate = (500000.25, 0, 0)"));
  writer_of("obj", clip, folder)->add(far);
  EXPECT_THAT(read_file(folder / "surface_000001.obj"), HasSubstr("v 500001.25 0 0"));
  writer_of("ply", clip, folder)->add(far);
  EXPECT_THAT(read_file(folder / "surface_000001.ply"), HasSubstr("comment shift 500000.25 0 0\n"));
}

TEST_F(Clips, EveryFormatHoldsACrateWhereItStands) {
  ClipInfo clip = clip_of_two();
  clip.objects = {crate()};
  // A quarter turn about y, and a shift: (0.1, -0.1, -0.1) comes to (0.9, 0.1, -0.1).
  const ObjectState turned{{{1, 0.2, 0}, Quaternion::about({0, 1.5707963267948966, 0})}, {}};
  for (const Format& format : formats()) {
    const auto target = format.one_file() ? folder / (std::string("crate") + format.extension) : folder;
    const auto writer = format.writer(clip, target);
    for (const int n : {1, 2}) {
      ClipFrame frame = frame_of_two(n);
      frame.objects = {n == 1 ? ObjectState{} : turned};
      writer->add(frame);
    }
    writer->finish();
  }
  const std::string usd = read_file(folder / "crate.usda");
  EXPECT_THAT(usd, HasSubstr("def Mesh \"crate\""));
  EXPECT_THAT(usd, HasSubstr("1: ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) )"));
  EXPECT_THAT(usd, HasSubstr("(1, 0.2, 0, 1) )"));
  EXPECT_THAT(usd, HasSubstr("color3f inputs:diffuseColor = (0.5, 0.25, 0.1)"));
  const std::string obj = read_file(folder / "collider-crate_000002.obj");
  float x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(obj.c_str() + obj.find("\nv ", obj.find("\nv ") + 1), "\nv %f %f %f", &x, &y, &z), 3);
  EXPECT_NEAR(x, 0.9f, 1e-6f);
  EXPECT_NEAR(y, 0.1f, 1e-6f);
  EXPECT_NEAR(z, -0.1f, 1e-6f);
  EXPECT_THAT(read_file(folder / "small_000002.glb"), HasSubstr("\"name\":\"crate\""));
  EXPECT_THAT(files(), testing::IsSupersetOf({"collider-crate_000001.ply", "crate-colliders.vtkhdf"}));
  EXPECT_THAT(read_file(folder / "small_000002.vdb"), HasSubstr("collider-crate"));
}

TEST_F(Clips, AFolderThatIsNotThereIsAnErrorOfTheRun) {
  const ClipInfo clip = clip_of_two();
  for (const Format& format : formats()) {
    const auto nowhere = folder / "no" / (format.one_file() ? std::string("clip") + format.extension : "");
    try {
      const auto writer = format.writer(clip, nowhere);
      writer->add(frame_of_two(1)), writer->finish();
      ADD_FAILURE() << format.name;
    } catch (const RunError& e) {
      EXPECT_THAT(e.what(), HasSubstr("cannot")) << format.name;
    }
  }
  EXPECT_THAT(files(), IsEmpty());
}

}  // namespace
}  // namespace dreampm::test
