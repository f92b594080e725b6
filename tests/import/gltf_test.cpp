// glTF files as the specification has them, and such as say of themselves what is not so.
#include "dreampm/import/gltf.h"

#include <gmock/gmock.h>

#include <cmath>

#include "geometry/meshes.h"

using namespace dreampm;
using testing::HasSubstr;

namespace {

std::string bytes_of(const std::vector<float>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size()};
}

/// A square in the plane z = 0, its corners in the order of a strip, and the indices 0 to 3 in
/// bytes.
const std::string square = bytes_of({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) + std::string("\0\1\2\3", 4);

class Gltf : public InFolder {
 protected:
  /// A file whose parts are these, with `square` as its buffer.
  Model read(const std::map<std::string, std::string>& parts) const {
    std::map<std::string, std::string> all{
        {"asset", R"({"version":"2.0"})"},
        {"scenes", R"([{"nodes":[0]}])"},
        {"nodes", R"([{"mesh":0}])"},
        {"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5}]}])"},
        {"accessors", R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                          {"bufferView":1,"componentType":5121,"count":4,"type":"SCALAR"}])"},
        {"bufferViews", R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":4}])"},
        {"buffers", R"([{"uri":"s.bin","byteLength":52}])"}};
    for (const auto& [key, value] : parts) all[key] = value;
    std::string text;
    for (const auto& [key, value] : all) text += (text.empty() ? "{\"" : ",\"") + key + "\":" + value;
    file("s.bin", square);
    return parse_gltf(text + "}", "s.gltf", folder);
  }
  std::string refused(const std::map<std::string, std::string>& parts) const {
    return refusal([&] { read(parts); });
  }
  static double normal_z(const Model& model, std::size_t t) {
    const auto& [a, b, c] = model.triangles[t];
    return cross(model.vertices[b] - model.vertices[a], model.vertices[c] - model.vertices[a]).z;
  }
};

std::string part(const std::string& more) { return R"([{"primitives":[{"attributes":{"POSITION":0})" + more + "}]}]"; }

TEST_F(Gltf, StripsFansAndTrianglesLookTheSameWay) {
  for (const char* more : {R"(,"indices":1,"mode":5)", R"(,"mode":5)"}) {
    const Model strip = read({{"meshes", part(more)}});
    ASSERT_EQ(strip.triangles.size(), 2u);
    for (std::size_t t = 0; t < 2; ++t) EXPECT_EQ(normal_z(strip, t), 1) << more;
  }
  const Model fan = read({{"meshes", part(R"(,"mode":6)")}});
  EXPECT_EQ(fan.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(read({{"meshes", part("")}}).triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
}

TEST_F(Gltf, NodesStandWithinOthersTurnedScaledAndMirrored) {
  // A quarter about z, then twice as large and 5 m on.
  const double h = std::sqrt(0.5);
  const Model turned = read({{"nodes", fmt::format(R"([{{"children":[1],"scale":[2,2,2],"translation":[5,0,0]}},
      {{"mesh":0,"rotation":[0,0,{},{}]}}])",
                                                   h, h)}});
  EXPECT_NEAR(length(turned.vertices[1] - Vec3d{5, 2, 0}), 0, 1e-12);
  EXPECT_NEAR(length(turned.vertices[2] - Vec3d{3, 0, 0}), 0, 1e-12);
  const Model mirrored = read({{"nodes", R"([{"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1]}])"}});
  EXPECT_EQ(mirrored.vertices[1], (Vec3d{-1, 0, 7}));
  EXPECT_EQ(normal_z(mirrored, 0), 1) << "a mirrored node keeps its outside outside";
}

TEST_F(Gltf, RowsMayLieApartAndBeGivenAnew) {
  const Model apart = read({{"bufferViews", R"([{"buffer":0,"byteLength":48,"byteStride":16},
      {"buffer":0,"byteOffset":48,"byteLength":4}])"},
                            {"accessors", R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}])"},
                            {"meshes", part("")}});
  EXPECT_EQ(apart.vertices, (std::vector<Vec3d>{{0, 0, 0}, {0, 1, 1}})) << "floats from 0, 4 and 8 on";
  const Model anew = read({{"accessors", R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",
      "sparse":{"count":1,"indices":{"bufferView":1,"byteOffset":3,"componentType":5121},
                "values":{"bufferView":0,"byteOffset":12}}}])"},
                           {"meshes", part("")}});
  EXPECT_EQ(anew.vertices.size(), 3u) << "the last corner is where the second is";
}

TEST_F(Gltf, WhatAFileDoesNotHoldIsRefusedByItsPlace) {
  using Parts = std::map<std::string, std::string>;
  const std::pair<Parts, const char*> wrong[]{
      {{{"asset", R"({"version":"1.0"})"}}, "asset: is of version 1.0; 2.0 is read"},
      {{{"scene", "1"}}, "scenes: has 1 entries, and number 1 of them is named"},
      {{{"nodes", R"([{"children":[0]}])"}}, "nodes[0]: stands in two places, or within itself"},
      {{{"nodes", R"([{"mesh":0,"scale":[1,2]}])"}}, "nodes[0].scale: has 2 numbers, 3 are wanted"},
      {{{"nodes", R"([{"mesh":-1}])"}}, "nodes[0].mesh: -1 is no whole number from 0 on"},
      {{{"buffers", R"([{"uri":"s.bin","byteLength":18446744073709551615}])"}},
       "buffers[0].byteLength: 18446744073709551615 is no whole number"},
      {{{"buffers", R"([{"uri":"s.bin","byteLength":53}])"}}, "buffers[0]: its byteLength is 53, and it has 52"},
      {{{"buffers", R"([{"byteLength":52}])"}}, "buffers[0]: has no uri, and no bytes follow"},
      {{{"buffers", R"([{"uri":"data:,x","byteLength":1}])"}}, "its data URI is not in base64"},
      {{{"bufferViews", R"([{"buffer":0,"byteLength":48,"byteOffset":9007199254740992}])"}},
       "bufferViews[0]: goes beyond the 52 bytes of its buffer"},
      {{{"bufferViews", R"([{"buffer":0,"byteLength":48,"byteStride":0}])"}}, "its byteStride is 0"},
      {{{"accessors", R"([{"bufferView":0,"componentType":5126,"count":9007199254740992,"type":"VEC3"}])"}},
       "accessors[0]: has 9007199254740992 rows, which 48 bytes do not hold"},
      {{{"accessors", R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC2"}])"}},
       "accessors[0]: is of type VEC2, VEC3 is wanted"},
      {{{"accessors", R"([{"componentType":5126,"count":4000000000,"type":"VEC3","sparse":{"count":1,
          "indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}}}])"}},
       "has 4000000000 rows, 1 of which are given"},
      {{{"meshes", part(R"(,"mode":7)")}}, "meshes[0].primitives[0]: its mode is 7, the last one is 6"},
      {{{"meshes", "7"}}, "meshes: must be a list"}};
  for (const auto& [parts, message] : wrong) {
    const std::string text = refused(parts);
    EXPECT_THAT(text, HasSubstr("s.gltf: cannot be read as a mesh: "));
    EXPECT_THAT(text, HasSubstr(message));
  }
}

}  // namespace
