#include "dreampm/import/asset.h"

#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numbers>
#include <numeric>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/import/dragon.h"
#include "dreampm/import/gzip.h"
#include "dreampm/import/import.h"

namespace dreampm {
namespace {

constexpr std::string_view prefix = "asset:";

std::string sha256_of(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr) != 1)
    fail_run("libcrypto cannot compute a SHA-256");
  std::string hex;
  for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

}  // namespace

bool is_asset(std::string_view name) { return name.starts_with(prefix); }

std::filesystem::path asset_folder() {
  const auto variable = [](const char* name) -> std::filesystem::path {
    const char* value = std::getenv(name);
    return value ? value : "";
  };
  if (auto own = variable("DREAMPM_CACHE"); !own.empty()) return own;
  if (auto base = variable("XDG_CACHE_HOME"); !base.empty()) return base / "dreampm";
  if (auto home = variable("HOME"); !home.empty()) return home / ".cache" / "dreampm";
  fail_input("there is no folder for fetched models: none of DREAMPM_CACHE, XDG_CACHE_HOME and HOME is set");
}

bool is_fetched(std::string_view name) {
  const std::string_view short_name = name.substr(is_asset(name) ? prefix.size() : 0);
  return std::any_of(std::begin(assets), std::end(assets), [&](const Asset& a) {
    return a.name == short_name && !a.file.empty() && std::filesystem::exists(asset_folder() / a.file);
  });
}

TriMesh torus_knot() {
  constexpr int along = 480, around = 36;
  constexpr double tube = 0.34;
  const auto curve = [](double t) {
    const double r = 1 + 0.45 * std::cos(3 * t);
    return Vec3d{r * std::cos(2 * t), r * std::sin(2 * t), 0.6 * std::sin(3 * t)};  // it stands
  };
  // A frame carried along without twist (double reflection, Wang, Juettler, Zheng, Liu 2008), whose
  // rest of twist after one turn is spread evenly, so that the ends meet.
  std::vector<Vec3d> points(along + 1), tangents(along + 1), sides(along + 1);
  for (int i = 0; i <= along; ++i) {
    const double t = 2 * std::numbers::pi * i / along, h = 1e-5;
    points[std::size_t(i)] = curve(t);
    tangents[std::size_t(i)] = normalized(curve(t + h) - curve(t - h));
  }
  sides[0] = normalized(cross(tangents[0], Vec3d{0, 1, 0}));
  for (std::size_t i = 0; i < along; ++i) {
    const Vec3d v1 = points[i + 1] - points[i];
    const Vec3d side = sides[i] - v1 * (2 * dot(v1, sides[i]) / length2(v1)),
                tangent = tangents[i] - v1 * (2 * dot(v1, tangents[i]) / length2(v1));
    const Vec3d v2 = tangents[i + 1] - tangent;
    sides[i + 1] = length2(v2) > 0 ? side - v2 * (2 * dot(v2, side) / length2(v2)) : side;
  }
  const Vec3d up0 = cross(tangents[0], sides[0]);
  const double twist = std::atan2(dot(sides[along], up0), dot(sides[along], sides[0]));

  TriMesh mesh;
  for (std::size_t i = 0; i < along; ++i) {
    const Vec3d up = cross(tangents[i], sides[i]);
    for (int j = 0; j < around; ++j) {
      const double a = 2 * std::numbers::pi * j / around - twist * double(i) / along;
      mesh.vertices.push_back(Vec3f(points[i] + (sides[i] * std::cos(a) + up * std::sin(a)) * tube));
    }
  }
  const auto vertex = [](int i, int j) { return std::uint32_t((i % along) * around + j % around); };
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
    }
  return mesh;
}

Model load_asset(std::string_view name) {
  const std::string_view short_name = name.substr(is_asset(name) ? prefix.size() : 0);
  if (short_name == "knot" || short_name == "dragon") {
    Model made = model_of(short_name == "knot" ? torus_knot() : little_dragon());
    made.parts = 1;
    return made;
  }
  for (const Asset& f : assets) {
    if (f.name != short_name || f.file.empty()) continue;
    const std::filesystem::path file = asset_folder() / f.file;
    constexpr std::string_view remedy =
        "`make demo` or tools/fetch_dragon fetches it; `--model FILE` takes a mesh of yours, and asset:dragon and "
        "asset:knot need "
        "no file";
    if (!std::filesystem::exists(file)) fail_input("{}: {} is not there. {}", name, file.string(), remedy);
    const std::string packed = read_file(file);
    std::string sum;
    try {
      sum = sha256_of(is_gzip(packed) ? unpack_gzip(packed, file.string()) : packed);
    } catch (const InputError& damage) {
      fail_input("{}: {}. Delete it; {}", name, damage.what(), remedy);
    }
    if (sum != f.sha256)
      fail_input("{}: {} is not the right file: its content has SHA-256 {}, wanted is {}. Delete it; {}", name,
                 file.string(), sum, f.sha256, remedy);
    return import_mesh(file);
  }
  const auto names = asset_names();
  fail_input("{}: there is no such asset; known are {}", name,
             std::accumulate(names.begin() + 1, names.end(), "asset:" + names[0],
                             [](const std::string& all, const std::string& n) { return all + ", asset:" + n; }));
}

}  // namespace dreampm
