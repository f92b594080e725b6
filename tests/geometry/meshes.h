// Small meshes made by code, and files for them.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "dreampm/base/error.h"
#include "dreampm/geometry/mesh.h"
#include "thrown.h"

namespace dreampm {
using test::refusal;

/// An octahedron cut `times` times, its vertices on a sphere about `center`.
inline TriMesh sphere_mesh(double radius, int times, Vec3d center = {}) {
  std::vector<Vec3d> p{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  TriMesh mesh;
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int t = 0; t < times; ++t) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(p.size()));
      if (fresh) p.push_back(normalized(p[a] + p[b]));
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (const Vec3d& v : p) mesh.vertices.push_back(Vec3f(v * radius + center));
  return mesh;
}

/// Takes away the faces whose centroid lies within `radius` of `at`.
inline TriMesh with_hole(TriMesh mesh, Vec3d at, double radius) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const Vec3d c = (Vec3d(mesh.vertices[t[0]]) + Vec3d(mesh.vertices[t[1]]) + Vec3d(mesh.vertices[t[2]])) / 3.0;
    return length(c - at) < radius;
  });
  return mesh;
}

inline TriMesh joined(TriMesh a, const TriMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return a;
}

/// A folder of its own for every test, gone after it.
class InFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() / ("dreampm-" + std::string(test->test_suite_name()) + "-" +
                                                       test->name() + "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::filesystem::path file(const std::string& name, const std::string& content) const {
    std::ofstream(folder / name, std::ios::binary) << content;
    return folder / name;
  }
  std::filesystem::path folder;
};

}  // namespace dreampm
