// Parts of pictures, what the first surfaces are like, and the denoiser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/render/camera.h"
#include "dreampm/render/denoise.h"
#include "dreampm/render/picture_exr.h"
#include "shapes.h"
#include "thrown.h"

namespace dreampm {
namespace {

using testing::HasSubstr;

/// A box of clear matter and a matte ball under the sun; without tiles, whose light takes time.
struct Still {
  TriMesh water = box_mesh({0, 0, 0}, {1, 0.3f, 0.6f}), ball = ball_mesh({0.5f, 0.6f, 0.3f}, 0.15f, 16);
  RenderScene scene;
  Still() {
    scene.basin = {{0, 0, 0}, {1, 1, 0.6f}};
    ball.velocities.assign(ball.vertices.size(), {0.3f, -0.9f, 0.2f});
    scene.objects = {{&water, model::Look::dielectric(), {}}, {&ball, model::Look::opaque({0.8, 0.4, 0.2}), {}}};
    scene.frame_time = 0.05;
    scene.stage.floor = model::Floor::none;
  }
};

TEST(Crop, ItsPixelsAreThoseOfTheWholePicture) {
  const Still still;
  RenderSettings settings;
  settings.width = 96, settings.height = 64, settings.samples = 12, settings.noise = 0.02f;
  const Picture whole = render_picture(still.scene, settings);
  const RgbImage shown = tone_map(whole);
  ASSERT_EQ(shown.pixels, tone_map(Image{96, 64, whole.linear}).pixels);
  for (const PixelBox& box : {PixelBox{30, 20, 61, 40}, {0, 0, 10, 64}, {90, 60, 96, 64}}) {
    settings.crop = box;
    const Picture part = render_picture(still.scene, settings);
    EXPECT_LT(part.traced.size(), whole.traced.size());
    const RgbImage there = tone_map(part);
    ASSERT_EQ(there.width, box.width());
    ASSERT_EQ(there.height, box.height());
    for (int y = 0; y < there.height; ++y)
      for (int x = 0; x < 3 * there.width; ++x)
        ASSERT_EQ(there.at(0, y)[x], shown.at(box.x0, box.y0 + y)[x]) << x << " " << y;
  }
  settings.crop = PixelBox{0, 0, 97, 64};
  EXPECT_THAT(test::refusal([&] { render_picture(still.scene, settings); }),
              HasSubstr("0,0,97,64 is no part of 96 x 64"));
  settings.crop = PixelBox{5, 5, 5, 9};
  EXPECT_THROW(render_picture(still.scene, settings), InputError);
}

TEST(FirstSurfaces, DepthNormalAlbedoAndMotionAreThoseOfTheBall) {
  Still still;
  still.scene.stage = {};
  still.scene.stage.basin = model::Basin::none;
  RenderSettings settings;
  settings.width = 96, settings.height = 64, settings.samples = settings.min_samples = 8, settings.surfaces = true;
  const Picture picture = render_picture(still.scene, settings);
  const trace::Camera camera(still.scene.camera, still.scene.basin, 96, 64);
  const Vec3f center{0.5f, 0.6f, 0.3f}, velocity{0.3f, -0.9f, 0.2f};
  const auto [x, y] = camera.project(center);
  const std::size_t i = static_cast<std::size_t>(y) * 96 + static_cast<std::size_t>(x);
  const FirstSurfaces& s = picture.surfaces;
  EXPECT_NEAR(s.depth[i], camera.depth(center) - 0.15f, 0.01f);
  const Vec3f toward = normalized(camera.eye() - center);
  EXPECT_LT(length(s.normal[i] - toward), 0.15f) << "of a pixel 0.1 of the radius wide";
  const Vec3f linear = linear_color(Vec3d{0.8, 0.4, 0.2});
  EXPECT_LT(length(s.albedo[i] - linear), 1e-4f);
  const Vec3f near = center + toward * 0.15f;
  const auto from = camera.project(near - velocity * 0.025f), to = camera.project(near + velocity * 0.025f);
  EXPECT_NEAR(s.motion[i][0], to.first - from.first, 0.1f);
  EXPECT_NEAR(s.motion[i][1], from.second - to.second, 0.1f) << "upwards";
  EXPECT_LT(s.motion[i][1], -1) << "it falls";
  // In the upper left corner there is sky, below the pool's far edge tiles.
  EXPECT_EQ(s.depth[0], sky_depth);
  EXPECT_EQ(s.normal[0], Vec3f{});
  EXPECT_GT(s.albedo[0].z, 0.2f);
  const std::size_t last = 63 * 96;
  EXPECT_NEAR(s.normal[last].y, 1, 1e-5f);
  EXPECT_GT(s.depth[last], 0);
  EXPECT_LT(s.depth[last], 20);
}

TEST(PictureExr, HasTheUsualChannels) {
  const Still still;
  RenderSettings settings;
  settings.width = 64, settings.height = 48, settings.samples = settings.min_samples = 4, settings.surfaces = true;
  settings.crop = PixelBox{16, 8, 48, 40};
  const Picture picture = render_picture(still.scene, settings);
  const ExrPicture exr = exr_of(picture);
  std::vector<std::string> names;
  for (const ExrChannel& c : exr.channels) names.push_back(c.name);
  EXPECT_THAT(names, testing::ElementsAre("R", "G", "B", "A", "Z", "normal.X", "normal.Y", "normal.Z", "albedo.R",
                                          "albedo.G", "albedo.B", "motion.X", "motion.Y"));
  EXPECT_EQ(exr.x, 16);
  EXPECT_EQ(exr.y, 8);
  EXPECT_EQ(exr.full_width, 64);
  EXPECT_EQ(exr.width, 32);
  const std::size_t inside = static_cast<std::size_t>(8 - picture.traced.y0) * std::size_t(picture.traced.width()) +
                             static_cast<std::size_t>(16 - picture.traced.x0);
  EXPECT_EQ(exr.channels[0].values[0], picture.linear[inside].x);
  EXPECT_EQ(exr.channel("Z")->values[0], picture.surfaces.depth[inside]);
  EXPECT_FALSE(exr.channel("Z")->half);
  EXPECT_TRUE(exr.channel("R")->half);
}

TEST(Report, TheErrorIsThatOfMoreSamples) {
  const Still still;
  RenderSettings settings;
  settings.width = 64, settings.height = 48, settings.samples = settings.min_samples = 16, settings.noise = 1;
  const Picture few = render_picture(still.scene, settings);
  EXPECT_EQ(few.report.samples, 16);
  EXPECT_EQ(few.report.at_limit, 0) << "no error is as large";
  settings.noise = 1e-6f;
  EXPECT_GT(render_picture(still.scene, settings).report.at_limit, 0.5);
  settings.samples = settings.min_samples = 64;
  EXPECT_NEAR(render_picture(still.scene, settings).report.error / few.report.error, 0.5, 0.15);
}

/// A library that takes the denoiser's place for a test; null: as the machine has it.
class Library {
 public:
  explicit Library(const char* file) { setenv("DREAMPM_OIDN", file, 1); }
  ~Library() { unsetenv("DREAMPM_OIDN"), unsetenv("OIDN_STAND_IN_FAILS"); }
};

TEST(Denoiser, WithoutOneTheErrorSaysWhatToInstall) {
  const Library none("/nowhere/libOpenImageDenoise.so.2");
  EXPECT_FALSE(find_denoiser().found);
  const std::string why = test::refusal([] { check_denoiser(); });
  EXPECT_THAT(why, HasSubstr("pip install pyoidn"));
  EXPECT_THAT(why, HasSubstr("/nowhere/libOpenImageDenoise.so.2"));
  const Still still;
  RenderSettings settings = small_picture(16, 16, 2);
  settings.denoise = true;
  EXPECT_THROW(render_picture(still.scene, settings), InputError);
}

TEST(Denoiser, OfAnotherLibraryItSaysWhatItLacks) {
  const Library other("libm.so.6");
  EXPECT_THAT(test::refusal([] { check_denoiser(); }), HasSubstr("libm.so.6 has no oidnNewDevice: version 2"));
}

TEST(Denoiser, GetsLightWithReflectanceAndNormalsWithoutNoise) {
  const Library stand_in(DM_OIDN_STAND_IN);
  EXPECT_THAT(find_denoiser().text, HasSubstr("Open Image Denoise 2.3.1"));
  std::vector<Vec3f> light, albedo, normal, expected;
  for (int i = 0; i < 12; ++i) {
    const auto x = static_cast<float>(i);
    light.push_back({x, 2 * x, 3 * x}), albedo.push_back({1, x, 0}), normal.push_back({0, 1, -x});
    expected.push_back(light.back() + albedo.back() * (4 * 0.5f) + normal.back() * (16 * 0.5f));
  }
  denoise(light, albedo, normal, 4, 3);
  EXPECT_EQ(light, expected);
}

TEST(Denoiser, IsGivenTheSurfacesOfThePicture) {
  const Library stand_in(DM_OIDN_STAND_IN);
  const Still still;
  RenderSettings settings = small_picture(24, 16, 4);
  settings.surfaces = true;
  const Picture plain = render_picture(still.scene, settings);
  settings.denoise = true;
  const Picture clean = render_picture(still.scene, settings);
  ASSERT_EQ(clean.linear.size(), plain.linear.size());
  for (std::size_t i = 0; i < plain.linear.size(); ++i)
    EXPECT_EQ(clean.linear[i], plain.linear[i] + plain.surfaces.albedo[i] * 2.0f + plain.surfaces.normal[i] * 8.0f);
}

TEST(Denoiser, ItsFailureIsAnErrorWithItsWords) {
  const Library stand_in(DM_OIDN_STAND_IN);
  setenv("OIDN_STAND_IN_FAILS", "out of memory", 1);
  std::vector<Vec3f> light(4), albedo(4), normal(4);
  try {
    denoise(light, albedo, normal, 2, 2);
    FAIL() << "nothing was said";
  } catch (const RunError& e) {
    EXPECT_THAT(e.what(), HasSubstr("out of memory"));
  }
}

TEST(Picture, EdgesBetweenColorsAreSampledWhateverTheNoiseAskedFor) {
  // A red plate before white, of which 4 samples a pixel are enough but for its edges.
  const TriMesh plate = box_mesh({-0.5f, -0.5f, -0.1f}, {0.5f, 0.53f, 0});
  const RenderScene scene = before_uniform_sky({&plate, model::Look::opaque(srgb_of({0.9f, 0.2f, 0.2f}))}, 30);
  RenderSettings settings = small_picture(64, 64, 4);
  settings.samples = 64, settings.noise = 10;
  const Picture all = render_picture(scene, settings);
  // Its edges are about 120 of 4,096 pixels, each with one beside it.
  EXPECT_GT(all.report.samples, 4.2);
  EXPECT_LT(all.report.samples, 6);
  settings.crop = PixelBox{28, 28, 36, 36};
  EXPECT_EQ(render_picture(scene, settings).report.samples, 4);
}

}  // namespace
}  // namespace dreampm
