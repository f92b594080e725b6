// A small clip: a cube of particles of two materials, and the mesh of a tetrahedron.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include "dreampm/export/clip.h"

namespace dreampm::test {
using namespace exchange;

inline ClipInfo clip_of_two(const Axes& axes = {}) {
  ClipInfo clip;
  clip.name = "small";
  clip.axes = axes;
  clip.fps = 25;
  clip.first = 1, clip.last = 2;
  clip.spacing = 0.1 * axes.scale;
  clip.materials = {{.name = "water", .ior = 1.33f}, {.name = "sand"}};
  clip.meshed = {0};
  return clip;
}

/// The writer of a format by its name.
inline std::unique_ptr<ClipWriter> writer_of(std::string_view format, const ClipInfo& clip,
                                             const std::filesystem::path& target) {
  for (const Format& f : formats())
    if (f.name == format) return f.writer(clip, target);
  throw std::logic_error("no such format");
}

/// 125 particles in [0, 0.5]^3 that fall at 2 m/s, and a tetrahedron.
inline ClipFrame frame_of_two(int number, const Axes& axes = {}) {
  ClipFrame frame;
  frame.number = number;
  ParticleFrame& p = frame.particles;
  p.material_names = {"water", "sand"};
  for (int i = 0; i < 125; ++i) {
    p.position.push_back({0.05f + 0.1f * float(i % 5), 0.05f + 0.1f * float(i / 5 % 5), 0.05f + 0.1f * float(i / 25)});
    p.velocity.push_back({0, -2, 0});
    p.id.push_back(i);
    p.material.push_back(std::uint8_t(i % 2));
  }
  axes.apply(p);
  TriMesh& mesh = frame.meshes.emplace_back();
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  mesh.normals.assign(4, {0, 1, 0});
  mesh.velocities.assign(4, {0, -2, 0});
  axes.apply(mesh);
  return frame;
}

/// A crate of 0.2 x 0.2 x 0.2 at the origin.
inline ClipObject crate(const Axes& axes = {}) {
  ClipObject object{{.name = "crate", .color = {0.5f, 0.25f, 0.1f}}, {}};
  for (int i = 0; i < 8; ++i)
    object.mesh.vertices.push_back({i & 1 ? 0.1f : -0.1f, i & 2 ? 0.1f : -0.1f, i & 4 ? 0.1f : -0.1f});
  object.mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                           {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  axes.apply(object.mesh);
  return object;
}

class InOwnFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / ("dreampm-exchange-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder))
      if (e.is_regular_file()) names.push_back(e.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  std::filesystem::path folder;
};

}  // namespace dreampm::test
