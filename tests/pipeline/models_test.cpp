// The same files for `dreampm points` and for bodies of scenes, and what is said of how particles
// show them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/io/ply.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/pipeline/inspect.h"
#include "dreampm/pipeline/points.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

class Models : public testing::Test {
 protected:
  Models() {
    folder_ = fs::path(DM_BINARY_DIR) / "test-files" / "models" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    make_folder(folder_);
  }
  std::string file(const std::string& name, const std::string& text) const {
    replace_file_text(folder_ / name, text);
    return (folder_ / name).string();
  }
  PointsReport points(const std::string& model, double spacing, std::optional<double> fit = {}) const {
    PointsRequest request;
    request.model = model, request.spacing = spacing, request.longest = fit;
    return write_points(request, folder_ / "out.ply");
  }
  /// A body of this shape in a space 2 m wide about the origin.
  static InitialState body(const std::string& shape, double spacing) {
    const auto parsed = scene::parse_scene_text(
        fmt::format("dreampm: 1\nname: one\nspace: {{min: [-1, -1, -1], max: [1, 1, 1], spacing: {}}}\n"
                    "time: {{fps: 10, frames: 1}}\nmaterials: {{jelly: {{type: elastic}}}}\n"
                    "bodies: {{it: {{material: jelly, shape: {}}}}}\n",
                    spacing, shape),
        "one.yaml");
    EXPECT_TRUE(parsed.ok()) << parsed.text();
    return assemble(parsed.scene, "one.yaml");
  }
  static std::string error_of(const std::function<void()>& call) {
    try {
      call();
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  fs::path folder_;
};

std::string text_of(const std::vector<std::string>& lines) { return fmt::format("{}", fmt::join(lines, "\n")); }
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A box about the origin, `thick` m along z and `wide` along x and y, as the lines of an OBJ.
std::string slab(double thick, double wide = 0.4) {
  std::string text;
  for (const double z : {-thick / 2, thick / 2})
    for (const double y : {-wide / 2, wide / 2})
      for (const double x : {-wide / 2, wide / 2}) text += fmt::format("v {} {} {}\n", x, y, z);
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

/// The same 0.2 m thick, in the formats of a list; `faces` may be left out.
std::string ply_slab(const std::string& head, bool faces = true) {
  std::string text = head + "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
  if (faces) text += "element face 6\nproperty list uchar int vertex_indices\n";
  text += "end_header\n";
  for (const char* z : {"-0.1", "0.1"})
    for (const char* y : {"-0.2", "0.2"})
      for (const char* x : {"-0.2", "0.2"}) text += fmt::format("{} {} {}\n", x, y, z);
  if (faces) text += "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
  return text;
}

/// The text as a gzip file, in one block that is not compressed.
std::string packed(const std::string& text) {
  std::uint32_t crc = ~0u;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  std::string out("\x1f\x8b\x08\0\0\0\0\0\0\xff\x01", 11);
  const auto add = [&](std::uint32_t value, int bytes) {
    for (; bytes > 0; --bytes, value >>= 8) out += static_cast<char>(value & 0xff);
  };
  const auto size = static_cast<std::uint32_t>(text.size());
  add(size, 2), add(~size, 2);
  out += text;
  add(~crc, 4), add(size, 4);
  return out;
}

TEST_F(Models, PointsAndScenesAcceptAndRefuseTheSameFiles) {
  enum class Is { mesh, cloud, neither };
  const std::string head = "ply\nformat ascii 1.0\n", good = ply_slab(head);
  std::string crlf, mixed = good, strips = ply_slab(head, false);
  for (const char c : good) crlf += c == '\n' ? "\r\n" : std::string(1, c);
  mixed.replace(mixed.find("4 0 2 3 1"), 9, "4 1 3 2 0");
  strips.replace(strips.find("end_header"), 10,
                 "element tristrips 1\nproperty list int int vertex_indices\nend_header");
  strips += "29 1 0 3 2 -1 4 5 6 7 -1 0 1 4 5 -1 6 7 2 3 -1 0 4 2 6 -1 1 3 5 7\n";
  const struct {
    std::string name, text;
    Is is;
  } files[] = {
      {"good.ply", good, Is::mesh},
      {"UPPER.PLY", good, Is::mesh},
      {"blank.ply", ply_slab("ply \nformat ascii 1.0\n"), Is::mesh},
      {"info.ply", ply_slab("ply\nobj_info x\nformat ascii 1.0\n"), Is::mesh},
      {"crlf.ply", crlf, Is::mesh},
      {"mixed.ply", mixed, Is::mesh},
      {"strips.ply", strips, Is::mesh},
      {"more.ply", good + "more\n", Is::mesh},
      {"slab.obj", slab(0.2), Is::mesh},
      {"slab.OBJ", "\xef\xbb\xbf" + slab(0.2), Is::mesh},
      {"cloud.ply", ply_slab(head, false), Is::cloud},
      {"CLOUD.PLY", ply_slab(head, false), Is::cloud},
      {"slab.ply.gz", packed(good), Is::mesh},
      {"slab.OBJ.GZ", packed(slab(0.2)), Is::mesh},
      {"cloud.ply.gz", packed(ply_slab(head, false)), Is::cloud},
      {"cut.ply.gz", packed(good).substr(0, 200), Is::neither},
      {"noformat.ply", ply_slab("ply\n"), Is::neither},
      {"later.ply", ply_slab("ply\nformat ascii 2.0\n"), Is::neither},
      {"twice.ply", ply_slab("ply\nformat ascii 1.0\nformat ascii 1.0\n"), Is::neither},
      {"cut.ply", good.substr(0, good.size() - 4), Is::neither},
      {"head.ply", good.substr(0, 60), Is::neither},
      {"empty.ply", "", Is::neither},
      {"other.ply", "hello\n", Is::neither},
      {"fans.ply", std::string(good).replace(good.find("face"), 4, "fans"), Is::neither},
      {"range.obj", slab(0.2) + "f 1 2 9\n", Is::neither},
      {"points.obj", "v 0 0 0\n", Is::neither},
      {"empty.stl", "", Is::neither},
      {"slab.blend", slab(0.2), Is::neither},
  };
  for (const auto& f : files) {
    const std::string path = file(f.name, f.text);
    std::size_t filled = 0;
    const std::string error = error_of([&] { filled = points(path, 0.04).points; }),
                      as_mesh = error_of([&] { body(fmt::format("{{mesh: {}}}", path), 0.04); }),
                      as_cloud = error_of([&] { body(fmt::format("{{points: {}}}", path), 0.04); }),
                      info = error_of([&] { inspect(path); });
    EXPECT_EQ(error.empty(), f.is != Is::neither) << f.name << ": " << error;
    EXPECT_EQ(as_mesh.empty(), f.is == Is::mesh) << f.name << ": " << as_mesh;
    EXPECT_EQ(info.empty(), f.is != Is::neither) << f.name << ": " << info;
    const bool ply = says(f.name, ".ply") || says(f.name, ".PLY");
    EXPECT_EQ(as_cloud.empty(), ply && f.is != Is::neither) << f.name << ": " << as_cloud;
    if (f.is == Is::mesh) {
      EXPECT_NEAR(static_cast<double>(filled), 500, 40) << f.name;
    }
    if (f.is == Is::cloud) {
      EXPECT_EQ(filled, 8u) << f.name;
      EXPECT_TRUE(says(as_mesh, "8 vertices but no faces; a scene takes a cloud of points by `points: FILE`"))
          << as_mesh;
    }
    if (f.is == Is::neither) {
      EXPECT_TRUE(says(as_mesh, f.name) && says(error, f.name)) << as_mesh << '\n' << error;
    }
  }
}

TEST_F(Models, WhatWasMendedInAMeshIsAWarningOfTheScene) {
  std::string text = slab(0.2);
  text.replace(text.find("f 1 3 4 2"), 9, "f 2 4 3 1");
  const std::string path = file("mixed.obj", text);
  EXPECT_EQ(text_of(body(fmt::format("{{mesh: {}}}", path), 0.02).warnings),
            path + ": 2 of 12 faces looked the other way than those beside them; turned");
}

/// The number after the last "a spacing of ".
double offered(const std::string& text) {
  const std::string key = "a spacing of ";
  const std::size_t at = text.rfind(key);
  return at == std::string::npos ? 0 : std::stod(text.substr(at + key.size()));
}

TEST_F(Models, WhatIsThinnerThanTheSpacingIsRefusedOrWarnedOfWithOneThatWouldDo) {
  for (const double thick : {0.0002, 0.009, 0.04}) {
    const std::string path = file("slab.obj", slab(thick, 0.1)),
                      mesh = fmt::format("{{mesh: {}, center: [0, 0, 0.0013]}}", path);
    std::string as_points, as_body;
    const std::string points_error = error_of([&] { as_points = text_of(points(path, 0.02).warnings); });
    const std::string body_error = error_of([&] { as_body = text_of(body(mesh, 0.02).warnings); });
    as_points += points_error, as_body += body_error;
    EXPECT_EQ(points_error.empty(), body_error.empty()) << points_error << '\n' << body_error;
    EXPECT_TRUE(thick == 0.04 || !as_points.empty());
    if (as_points.empty()) continue;
    if (thick < 0.001) {
      for (const std::string& text : {as_points, as_body})
        EXPECT_TRUE(says(text, "it is about 0.0002 m thick: use a spacing of a quarter of that or less")) << text;
      continue;
    }
    const double fine = offered(as_points);
    EXPECT_EQ(fine, offered(as_body)) << as_points << '\n' << as_body;
    EXPECT_GT(fine, thick / 4) << as_points;
    EXPECT_LT(fine, 0.02) << as_points;
    EXPECT_EQ(text_of(points(path, fine).warnings), "") << thick;
  }
}

TEST_F(Models, BodiesThatHoldAnotherVolumeThanTheirShapesAreWarnedOf) {
  EXPECT_EQ(text_of(body("{box: {size: [0.4, 0.4, 0.4]}, center: [0, 0, 0]}", 0.02).warnings), "");
  const std::string flat = text_of(body("{box: {size: [0.4, 0.004, 0.4]}, center: [0, 0, 0]}", 0.02).warnings);
  EXPECT_TRUE(says(flat, "the particles of body it hold 0.0")) << flat;
  EXPECT_TRUE(says(flat, "its shape 0.00064 m^3 (+")) << flat;
  EXPECT_EQ(text_of(body("{box: {size: [0.4, 0.004, 0.4]}, center: [0, 0, 0]}", offered(flat)).warnings), "") << flat;
  const std::string shell =
      "{difference: [{sphere: {radius: 0.2}, center: [0, 0, 0]}, {sphere: {radius: 0.19}, center: [0, 0, 0]}]}";
  const std::string thin = text_of(body(shell, 0.04).warnings);
  EXPECT_TRUE(says(thin, "the particles of body it hold")) << thin;
  EXPECT_EQ(text_of(body(shell, offered(thin)).warnings), "") << thin;
  const std::string lost = error_of([] {
    body(
        "{difference: [{box: {size: [0.1, 0.1, 0.1]}, center: [0, 0, 0]}, {box: {size: [0.099, 1, 1]}, center: [0, 0, "
        "0]}]}",
        0.04);
  });
  EXPECT_TRUE(says(lost, "body it holds no particle at spacing 0.04 m")) << lost;
  const std::string ball = "{sphere: {radius: 0.004}, center: [0, 0, 0]}";
  const std::string none = error_of([&] { body(ball, 0.02); });
  EXPECT_TRUE(says(none, "body it holds no particle at spacing 0.02 m")) << none;
  EXPECT_EQ(text_of(body(ball, offered(none)).warnings), "") << none;
}

TEST_F(Models, WholeRowsExplainWhatASmallBodyIsOff) {
  const auto warned = [](const std::string& size, const std::string& particles) {
    const InitialState all = body(fmt::format("{{box: {{size: {}}}, center: [0, 0, 0]}}", size), 0.02);
    EXPECT_EQ(std::to_string(all.particles()), particles) << size;
    return text_of(all.warnings);
  };
  // 2.65 spacings are three rows: 27 particles, 45 % too many.
  EXPECT_EQ(warned("[0.053, 0.053, 0.053]", "27"), "");
  EXPECT_TRUE(says(warned("[0.1, 0.033, 0.1]", "50"), "(+21 %)"));
  // One of two rows, and one of seven for 6.65.
  EXPECT_TRUE(says(warned("[0.133, 0.133, 0.133]", "343"), "(+17 %)"));
}

TEST_F(Models, CloudsThatDoNotFitTheSpacingAreWarnedOf) {
  const auto cloud = [&](const std::vector<Vec3d>& points) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double "
        "z\nend_header\n",
        points.size());
    for (const Vec3d& p : points) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    return file("cloud.ply", text);
  };
  const auto warned = [&](const std::vector<Vec3d>& points, double spacing) {
    const std::string path = cloud(points),
                      as_body = text_of(body(fmt::format("{{points: {}}}", path), spacing).warnings),
                      as_points = text_of(this->points(path, spacing).warnings);
    EXPECT_EQ(as_body.empty(), as_points.empty()) << as_body << '\n' << as_points;
    return as_body;
  };
  Shape ball;
  ball.form = SphereShape{0.2};
  ball.center = Vec3d{};
  const auto region = make_region(ball, 0.02, mesh_regions());
  for (const Pattern pattern : {Pattern::lattice, Pattern::jitter, Pattern::poisson}) {
    std::vector<Vec3d> points = sample_region(*region, 0.02, pattern, 3);
    EXPECT_NEAR(*look_at_cloud(points).spacing, 0.02, 0.002);
    EXPECT_EQ(warned(points, 0.02), "");
    EXPECT_TRUE(says(warned(points, 0.01), "body it: its points lie about 0.0"));
    EXPECT_TRUE(says(warned(points, 0.04), "times the volume that they fill; use a spacing of 0.0"));
    const std::size_t n = points.size();
    points.insert(points.end(), points.begin(), points.begin() + 7);
    const std::string twice = warned(points, 0.02);
    EXPECT_TRUE(
        says(twice, fmt::format("7 of {} points lie in the place of another, so matter is there twice; its points "
                                "lie about 0.0",
                                n + 7)))
        << twice;
    EXPECT_NEAR(*look_at_cloud(points).spacing, 0.02, 0.002);
  }
  // All in one cell.
  EXPECT_TRUE(says(warned(sample_region(*region, 0.05, Pattern::jitter, 1), 0.4), "together they hold"));
  std::vector<Vec3d> sheet;  // one layer
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 20; ++k) sheet.push_back({0.02 * i, 0, 0.02 * k});
  EXPECT_EQ(warned(sheet, 0.02), "");
}

TEST_F(Models, ASmallMeshInALongSpaceIsNotRefused) {
  const auto parsed = scene::parse_scene_text(
      "dreampm: 1\nname: long\nspace: {min: [0, 0, 0], max: [10, 0.6, 0.3], spacing: 0.01}\n"
      "time: {fps: 24, frames: 1}\nmaterials: {jelly: {type: elastic}}\n"
      "bodies: {knot: {material: jelly, shape: {mesh: asset:knot, fit: {longest: 0.25}, center: [0.3, 0.3, 0.15]}}}\n",
      "long.yaml", {.variant = {}, .overrides = {}, .assets = {"knot"}});
  ASSERT_TRUE(parsed.ok()) << parsed.text();
  EXPECT_NEAR(static_cast<double>(assemble(parsed.scene, "long.yaml").particles()), 2250, 60);
}

TEST_F(Models, PointsFarFromTheOriginAreWrittenInDouble) {
  std::string text;
  const Vec3d place{500000.125, 4000000.5, 120};
  for (int corner = 0; corner < 8; ++corner)
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", place.x + (corner & 1 ? 0.2 : -0.2),
                        place.y + (corner & 2 ? 0.2 : -0.2), place.z + (corner & 4 ? 0.2 : -0.2));
  const std::string faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const PointsReport report = points(file("far.obj", text + faces), 0.02);
  EXPECT_NEAR(static_cast<double>(report.points), 8000, 80);
  EXPECT_GE(report.nearest, 0.5 * 0.02 * (1 - 1e-4));
  const std::vector<Vec3d> back = read_point_cloud(folder_ / "out.ply");
  EXPECT_EQ(back.size(), report.points);
  Box3d box;
  for (const Vec3d& p : back) box.add(p - place);
  for (int a = 0; a < 3; ++a) {
    EXPECT_GT(box.min[a], -0.2 - 1e-6);
    EXPECT_LT(box.max[a], 0.2 + 1e-6);
    EXPECT_NEAR(box.size()[a], 0.39, 0.01);
  }
  EXPECT_NEAR(*look_at_cloud(back).spacing, 0.02, 0.002);
}

}  // namespace
}  // namespace dreampm
