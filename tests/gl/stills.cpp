// Draws particles of files, to look at, and times drawing. No test: what a picture should look like
// is a matter of eyes.
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "dreampm/error.h"
#include "dreampm/gl/bench.h"
#include "dreampm/gl/headless.h"
#include "dreampm/gl/renderer.h"
#include "dreampm/io/ply.h"
#include "dreampm/io/png.h"

namespace dreampm::gl {
namespace {

constexpr const char* usage = R"(gl_stills bench [LOOK...]           CPU and wall ms a frame
gl_stills draw OUT.png FRAME.ply KEY=VALUE...
  look=water       of all particles; look.NAME=LOOK of one material
  liquid=honey     water, honey
  opacity.NAME=0.5 of one material
  theme=light      light, dark
  spacing=0.0107   m, between particles
  radius=0.0086    m; default 0.8 spacing
  size=1280x720
  value=speed      color by speed
  min=x,y,z max=x,y,z   the domain
  eye=x,y,z target=x,y,z
  cube=x,y,z,side  a red cube, turned by 25 degrees
  ring=1
Looks: points, spheres, grains, skin, water.
)";

using Options = std::map<std::string, std::string>;

std::string get(const Options& o, const std::string& key, const std::string& fallback) {
  const auto it = o.find(key);
  return it == o.end() ? fallback : it->second;
}
std::vector<float> numbers(const std::string& text) {
  std::vector<float> out;
  for (const char* p = text.c_str(); *p;) {
    char* end = nullptr;
    out.push_back(std::strtof(p, &end));
    p = *end ? end + 1 : end;
  }
  return out;
}
Vec3f vector(const std::string& text) {
  const std::vector<float> v = numbers(text);
  return v.size() == 3 ? Vec3f{v[0], v[1], v[2]} : throw InputError("wanted x,y,z: " + text);
}

struct Cube {
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  explicit Cube(float side) {
    for (int k = 0; k < 8; ++k)
      vertices.push_back(Vec3f{(k & 1) ? 0.5f : -0.5f, (k & 2) ? 0.5f : -0.5f, (k & 4) ? 0.5f : -0.5f} * side);
    for (const std::array<std::uint32_t, 4> q : {std::array<std::uint32_t, 4>{0, 4, 6, 2},
                                                 {1, 3, 7, 5},
                                                 {0, 1, 5, 4},
                                                 {2, 6, 7, 3},
                                                 {0, 2, 3, 1},
                                                 {4, 5, 7, 6}}) {
      triangles.push_back({q[0], q[1], q[2]});
      triangles.push_back({q[0], q[2], q[3]});
    }
  }
};

void draw(const std::string& out, const std::string& file, const Options& o) {
  const HeadlessContext context;
  const ParticleFrame frame = read_particles(file);
  const std::size_t kinds = std::max<std::size_t>(frame.material_names.size(), 1);
  std::vector<std::vector<Vec3f>> position(kinds);
  std::vector<std::vector<float>> speed(kinds);
  for (std::size_t k = 0; k < frame.size(); ++k) {
    const std::size_t m = frame.material.empty() ? 0 : frame.material[k];
    position[m].push_back(frame.position[k]);
    speed[m].push_back(length(frame.velocity[k]));
  }
  const float spacing = std::stof(get(o, "spacing", "0.0107"));
  std::vector<ParticleBatch> batches(kinds);
  std::vector<std::string> looks(kinds);
  for (std::size_t m = 0; m < kinds; ++m) {
    ParticleBatch& b = batches[m];
    b.position = position[m];
    b.spacing = spacing;
    b.radius = std::stof(get(o, "radius", std::to_string(0.8f * spacing)));
    const std::string name = frame.material_names.empty() ? "" : frame.material_names[m];
    b.look = looks[m] = get(o, "look." + name, get(o, "look", "water"));
    if (name == "jelly") b.base_color = {0.93f, 0.33f, 0.23f};
    if (get(o, "liquid", "water") == "honey") b.liquid = {{1.0f, 7.0f, 34.0f}, {0.93f, 0.60f, 0.12f}, 3.0f, 1.49f};
    if (o.contains("color")) b.base_color = vector(o.at("color"));
    b.opacity = std::stof(get(o, "opacity." + name, "1"));
    if (o.contains("value")) {
      b.value = speed[m];
      b.value_max = 3;
    }
  }
  Picture picture;
  picture.particles = batches;
  picture.domain = {vector(get(o, "min", "0,0,0")), vector(get(o, "max", "1,1,1"))};
  picture.lights = lights_for(picture.domain);
  picture.theme = get(o, "theme", "light") == "dark" ? dark_theme() : light_theme();
  Camera camera;
  camera.eye = vector(get(o, "eye", "0.5,1.0,1.95"));
  camera.target = vector(get(o, "target", "0.5,0.3,0.5"));
  MeshBatch mesh;
  const std::vector<float> at = numbers(get(o, "cube", "0,0,0,0.1"));
  const Cube cube(at.at(3));
  if (o.contains("cube")) {
    mesh.vertices = cube.vertices;
    mesh.triangles = cube.triangles;
    mesh.pose = {{at[0], at[1], at[2]}, Quaternion::about({0, 0.436, 0})};
    mesh.color = {0.93f, 0.33f, 0.23f};
    picture.meshes = {&mesh, 1};
  }
  if (o.contains("ring")) picture.ring = BrushRing{picture.domain.center(), {0, 1, 0}, 0.12f};
  const std::string size = get(o, "size", "1280x720");
  const Framebuffer framebuffer(std::stoi(size), std::stoi(size.substr(size.find('x') + 1)));
  Renderer renderer;
  renderer.draw(picture, camera, framebuffer);
  write_png(out, framebuffer.read());
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() >= 1 && arguments[0] == "bench") {
    std::vector<std::string> looks(arguments.begin() + 1, arguments.end());
    if (looks.empty()) looks = {"points", "spheres", "grains", "skin", "water"};
    for (const std::string& look : looks) {
      DrawingBenchOptions options;
      options.look = look;
      const DrawingBenchResult r = bench_drawing(options);
      std::cout << look << ": " << r.cpu_ms << " ms of CPU, " << r.wall_ms << " ms of wall clock a frame, " << r.driver
                << '\n';
    }
    return 0;
  }
  if (arguments.size() < 3 || arguments[0] != "draw") {
    std::cout << usage;
    return 2;
  }
  Options options;
  for (std::size_t k = 3; k < arguments.size(); ++k) {
    const std::size_t equals = arguments[k].find('=');
    options[arguments[k].substr(0, equals)] = equals == std::string::npos ? "" : arguments[k].substr(equals + 1);
  }
  draw(arguments[1], arguments[2], options);
  return 0;
}

}  // namespace
}  // namespace dreampm::gl

int main(int count, char** arguments) {
  try {
    return dreampm::gl::run({arguments + 1, arguments + count});
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
