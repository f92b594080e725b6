// The Stanford dragon as points, where tools/fetch_dragon has put it: `make test-dragon`. Its full
// mesh has 407 holes and 151 loose pieces; its res2 has neither.
#include <gtest/gtest.h>

#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/import/asset.h"
#include "dreampm/pipeline/points.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

constexpr double spacing = 0.003;

class Dragon : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* f : {"dragon_vrip.ply.gz", "dragon_vrip_res2.ply.gz"})
      ASSERT_TRUE(fs::exists(asset_folder() / f)) << asset_folder() / f << " is not there: make test-dragon fetches it";
    folder_ = fs::path(DM_BINARY_DIR) / "test-files" / "dragon";
    make_folder(folder_);
  }
  PointsReport fill(const std::string& model, const std::string& file) const {
    PointsRequest request;
    request.model = model, request.spacing = spacing, request.longest = 0.8;
    return write_points(request, folder_ / file);
  }
  fs::path folder_;
};

double sum_of(const PointsReport& r) { return static_cast<double>(r.points) * spacing * spacing * spacing; }

TEST_F(Dragon, FillsItsVolumeWithPointsThatKeepApartAndRes2Agrees) {
  const PointsReport full = fill("asset:stanford-dragon", "full.ply");
  EXPECT_NEAR(sum_of(full) / *full.volume, 1, 0.01);
  EXPECT_EQ(full.outside, 0u);
  EXPECT_GE(full.nearest, 0.5 * spacing * (1 - 1e-4));  // positions are rounded to float

  const PointsReport res2 = fill("asset:stanford-dragon-res2", "res2.ply");
  EXPECT_NEAR(sum_of(res2) / *res2.volume, 1, 0.01);
  EXPECT_NEAR(*res2.volume / *full.volume, 1, 0.005);
  EXPECT_NEAR(sum_of(res2) / sum_of(full), 1, 0.005);

  fill("asset:stanford-dragon", "again.ply");
  EXPECT_EQ(read_file(folder_ / "full.ply"), read_file(folder_ / "again.ply"));
}

}  // namespace
}  // namespace dreampm
