// The dialogs about films, clicked where their buttons stand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "play/app_fixture.h"

namespace dreampm::play::render_panel_test {
namespace {
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

class RenderPanel : public test::AppFixture {};

TEST_F(RenderPanel, RenderAsksForAnEstimateAndStartsOnlyWhenTold) {
  window_width = 1280, window_height = 720;
  start();
  point_at("render"), click();
  EXPECT_THAT(posted, ElementsAre("set paused 1", AllOf(StartsWith("estimate tank-film-001.yaml 3 "), EndsWith(" 34"))))
      << "what is seen now";
  posted.clear(), rest();
  point_at("render start"), click();
  EXPECT_THAT(posted, ElementsAre(StartsWith("render tank-film-001.yaml 3 "), "set paused 0"));
  posted.clear(), rest();
  point_at("render"), click(), rest();
  posted.clear();
  point_at("render cancel"), click();
  EXPECT_THAT(posted, ElementsAre("render off", "set paused 0"));
}

TEST_F(RenderPanel, AFilmUnderWayIsShownAndTheWindowAsksBeforeItCloses) {
  window_width = 1280, window_height = 720;
  Frame with = *playground->frame();
  EXPECT_TRUE(app->may_close(with));
  RenderStatus film;
  film.state = RenderStatus::State::running, film.scene = "a.yaml", film.stage = "render", film.done = 3;
  film.frames = 48, film.share = 0.5, film.left = 75;
  const auto show = [&] {
    with.rendering = std::make_shared<const RenderStatus>(film);
    for (int n = 0; n < 3; ++n) {
      input.time += 1.0 / 60;
      app->update(with, input, window_width, window_height, 1);
    }
  };
  const auto click_at = [&](const std::string& what) {
    const Place p = place(what);
    input.inside = true, input.x = 0.5 * static_cast<double>(p.left + p.right);
    input.y = 0.5 * static_cast<double>(p.top + p.bottom);
    show(), input.left = true, show(), input.left = false, show();
    input.time += 1;
  };
  show();
  click_at("render off");
  EXPECT_THAT(posted, ElementsAre("render off"));
  posted.clear();
  EXPECT_FALSE(app->may_close(with));
  show();
  click_at("close stay");
  EXPECT_FALSE(app->asks_to_close());
  EXPECT_FALSE(app->may_close(with));
  show();
  click_at("close leave");
  EXPECT_THAT(posted, ElementsAre("render leave"));
  EXPECT_TRUE(app->may_close(with));
  film.state = RenderStatus::State::done, film.film = "out/a/a.mp4";
  show();
  EXPECT_GT(place("render open").right, 0);
  click_at("render close");
  const auto& places = app->places();
  EXPECT_TRUE(std::none_of(places.begin(), places.end(), [](const Place& p) { return p.what == "render open"; }));
}

}  // namespace
}  // namespace dreampm::play::render_panel_test
