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

/// Where there is no denoiser its tests say so.
#define NEED_DENOISER() \
  if (!find_denoiser().found) GTEST_SKIP() << find_denoiser().text

TEST(Denoiser, WithoutOneTheErrorSaysWhatToInstall) {
  const DenoiserState state = find_denoiser();
  if (state.found) {
    EXPECT_THAT(state.text, HasSubstr("Open Image Denoise 2."));
    EXPECT_NO_THROW(check_denoiser());
    return;
  }
  EXPECT_THAT(test::refusal([] { check_denoiser(); }), HasSubstr("pip install pyoidn"));
  const Still still;
  RenderSettings settings = small_picture(16, 16, 2);
  settings.denoise = true;
  EXPECT_THROW(render_picture(still.scene, settings), InputError);
}

TEST(Denoiser, TakesNoiseOutTheSameForAnyNumberOfThreads) {
  NEED_DENOISER();
  const Still still;
  RenderSettings settings;
  settings.width = 128, settings.height = 96, settings.samples = settings.min_samples = 128;
  const auto error = [&](const Picture& p, const Picture& good) {
    double sum = 0;
    for (std::size_t i = 0; i < p.linear.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double a = std::min(1.0f, p.linear[i][k]), b = std::min(1.0f, good.linear[i][k]);
        sum += (a - b) * (a - b);
      }
    return std::sqrt(sum / (3.0 * static_cast<double>(p.linear.size())));
  };
  const Picture good = render_picture(still.scene, settings);
  settings.samples = settings.min_samples = 4, settings.seed = 2;
  const Picture noisy = render_picture(still.scene, settings);
  settings.denoise = true;
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return render_picture(still.scene, settings);
  };
  const Picture clean = with(1);
  EXPECT_LT(error(clean, good), 0.7 * error(noisy, good));
  const Picture again = with(2);
  for (std::size_t i = 0; i < clean.linear.size(); ++i) ASSERT_EQ(clean.linear[i], again.linear[i]) << i;
}

}  // namespace
}  // namespace dreampm
