// Scenes that were parsed can be written and read back; hashes change with what they cover and with
// nothing else.
#include "dreampm/scene/emit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/scene/check.h"
#include "dreampm/scene/parse.h"

namespace dreampm::scene {
namespace {

bool same(const Values& a, const Values& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.first == q.first && (p.second == q.second || (std::isnan(p.second) && std::isnan(q.second)));
  });
}

bool same(const Shape& a, const Shape& b) {
  if (a.form.index() != b.form.index() || !(a.rotate_axis == b.rotate_axis) || a.rotate_angle != b.rotate_angle ||
      a.center != b.center)
    return false;
  if (const auto* p = std::get_if<BoxShape>(&a.form)) return p->size == std::get<BoxShape>(b.form).size;
  if (const auto* p = std::get_if<SphereShape>(&a.form)) return p->radius == std::get<SphereShape>(b.form).radius;
  if (const auto* p = std::get_if<CylinderShape>(&a.form)) {
    const auto& q = std::get<CylinderShape>(b.form);
    return p->radius == q.radius && p->height == q.height;
  }
  if (const auto* p = std::get_if<PlaneShape>(&a.form)) {
    const auto& q = std::get<PlaneShape>(b.form);
    return p->point == q.point && p->normal == q.normal;
  }
  if (const auto* p = std::get_if<MeshShape>(&a.form)) {
    const auto& q = std::get<MeshShape>(b.form);
    return p->path == q.path && p->longest == q.longest && p->scale == q.scale;
  }
  if (const auto* p = std::get_if<PointsShape>(&a.form)) {
    const auto& q = std::get<PointsShape>(b.form);
    return p->path == q.path && p->scale == q.scale;
  }
  const auto all_same = [](const std::vector<Shape>& p, const std::vector<Shape>& q) {
    return std::equal(p.begin(), p.end(), q.begin(), q.end(),
                      [](const Shape& x, const Shape& y) { return same(x, y); });
  };
  if (const auto* p = std::get_if<ContainerShape>(&a.form)) {
    const auto& q = std::get<ContainerShape>(b.form);
    return all_same(p->hollow, q.hollow) && p->wall == q.wall && p->open == q.open && p->up == q.up &&
           p->cut == q.cut && p->form == q.form;
  }
  const auto &p = std::get<BooleanShape>(a.form), &q = std::get<BooleanShape>(b.form);
  return p.op == q.op && all_same(p.parts, q.parts);
}

bool same(const ProbeForm& a, const ProbeForm& b) {
  if (a.index() != b.index()) return false;
  if (const auto* p = std::get_if<HeightProbe>(&a)) {
    const auto& q = std::get<HeightProbe>(b);
    return p->x == q.x && p->z == q.z;
  }
  if (const auto* p = std::get_if<PressureProbe>(&a)) {
    const auto& q = std::get<PressureProbe>(b);
    return p->at == q.at && p->normal == q.normal && p->radius == q.radius;
  }
  if (const auto* p = std::get_if<VelocityProbe>(&a)) {
    const auto& q = std::get<VelocityProbe>(b);
    return p->at == q.at && p->radius == q.radius;
  }
  if (const auto* p = std::get_if<FluxProbe>(&a)) {
    const auto& q = std::get<FluxProbe>(b);
    return p->point == q.point && p->normal == q.normal;
  }
  if (const auto* p = std::get_if<RegionProbe>(&a)) return same(p->shape, std::get<RegionProbe>(b).shape);
  if (const auto* p = std::get_if<ForceProbe>(&a)) {
    const auto& q = std::get<ForceProbe>(b);
    return p->on == q.on;
  }
  if (const auto* p = std::get_if<ExtentProbe>(&a)) {
    const auto& q = std::get<ExtentProbe>(b);
    return p->axis == q.axis && p->material == q.material;
  }
  const auto &p = std::get<PointProbe>(a), &q = std::get<PointProbe>(b);
  return p.body == q.body && p.at == q.at;
}

void expect_same(const model::Scene& a, const model::Scene& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.about, b.about);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_TRUE(a.space == b.space);
  EXPECT_TRUE(a.time == b.time);
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.gravity_keys, b.gravity_keys);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    EXPECT_EQ(a.fields[i].name, b.fields[i].name);
    ASSERT_EQ(a.fields[i].box.has_value(), b.fields[i].box.has_value());
    EXPECT_TRUE(!a.fields[i].box ||
                (a.fields[i].box->min == b.fields[i].box->min && a.fields[i].box->max == b.fields[i].box->max));
    EXPECT_EQ(a.fields[i].type, b.fields[i].type);
    EXPECT_TRUE(same(a.fields[i].numbers, b.fields[i].numbers)) << a.fields[i].name;
    EXPECT_TRUE(a.fields[i].vectors == b.fields[i].vectors) << a.fields[i].name;
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    EXPECT_EQ(a.materials[i].name, b.materials[i].name);
    EXPECT_EQ(a.materials[i].type, b.materials[i].type);
    EXPECT_TRUE(same(a.materials[i].values, b.materials[i].values)) << a.materials[i].name;
    EXPECT_EQ(a.materials[i].transfer, b.materials[i].transfer);
    EXPECT_TRUE(same(a.materials[i].transfer_values, b.materials[i].transfer_values)) << a.materials[i].name;
  }
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const model::Body &p = a.bodies[i], &q = b.bodies[i];
    EXPECT_TRUE(p.name == q.name && p.material == q.material && p.velocity == q.velocity && p.spin == q.spin &&
                p.color == q.color && p.pattern == q.pattern && same(p.shape, q.shape))
        << p.name;
  }
  ASSERT_EQ(a.colliders.size(), b.colliders.size());
  for (std::size_t i = 0; i < a.colliders.size(); ++i) {
    const model::Collider &p = a.colliders[i], &q = b.colliders[i];
    EXPECT_TRUE(p.name == q.name && p.type == q.type && p.friction == q.friction && p.thickness == q.thickness &&
                p.holds == q.holds && same(p.shape, q.shape))
        << p.name;
  }
  ASSERT_EQ(a.probes.size(), b.probes.size());
  for (std::size_t i = 0; i < a.probes.size(); ++i) {
    const model::Probe &p = a.probes[i], &q = b.probes[i];
    EXPECT_TRUE(p.name == q.name && p.rate == q.rate && same(p.form, q.form)) << p.name;
  }
  EXPECT_TRUE(a.output == b.output);
  EXPECT_TRUE(a.surface == b.surface);
  EXPECT_TRUE(a.render == b.render);
  EXPECT_TRUE(a.video == b.video);
}

model::Scene parsed(const std::string& text) {
  const ParseResult r = parse_scene_text(text, "scene.yaml");
  EXPECT_TRUE(r.ok()) << r.text();
  return r.scene;
}

// Every section and every form, no value that is the default.
const std::string everything = R"(dreampm: 1
name: all-of-it
about: "quotes \" and: colons, a backslash \\ and é"
seed: 9223372036854775807
space:
  min: [-0.1, 0, 0.3]
  max: [1.05, 1.2, 0.9]
  spacing: 0.0123456789012345
  particles_per_cell: 6.5
  periodic: [z]
  walls: {all: {type: slip, friction: 0.25}, x_min: {skin_friction: true}, floor: {type: stick}, x_max: {type: open}}
time: {fps: 30, frames: 17, dt: 1.0e-4, damping: 0.1, surface_contact: false}
gravity: {keys: [{t: 0.5, value: [0.1, -3, 1e-7]}, {t: 2, value: [0, 0, 1]}]}
emitters:
  tap: {material: water, shape: {sphere: {radius: 0.1}, center: [0.5, 0.5, 0.5]}, velocity: [0, -1, 0], start: 0.5, stop: 2, color: [0.9, 0.1, 0.4], pool: 100, recycle: true}
  hose: {material: water, shape: {sphere: {radius: 0.1}, center: [0.5, 0.5, 0.5]}, flow: 0.001, direction: [1, 0, 0], pool: 7}
sinks: {drain: {shape: {box: {size: [0.1, 0.1, 0.1]}, center: [0.5, 0.1, 0.5]}}}
rigid:
  crate: {shape: {box: {size: [0.1, 0.1, 0.1]}}, density: 400, position: [0.5, 0.5, 0.5], velocity: [0, 1, 0], spin: [1, 0, 0], friction: 0.2, restitution: 0.5, lock: [x, rz]}
  ball: {shape: {sphere: {radius: 0.1}, center: [0.2, 0.5, 0.5]}, mass: 2}
materials:
  water: {type: newtonian, bulk_modulus: 3.3e5, gamma: linear, tension: true, relaxation: 0, transfer: asflip, separation: 0.5, flip_memory: 0.02}
  oil: {type: newtonian, preset: oil, max_compression: 0.03}
  jelly: {type: elastic, preset: jelly, transfer: flip, flip_blend: 0.9}
  stone: {type: seed, elastic: true, lower: -100}
bodies:
  a: {material: stone, shape: {box: {min: [0, 0, 0.4], max: [0.1, 0.2, 0.5]}, rotate: {axis: [1, 2, 3], angle: 33}}, velocity: [1, 2, 3]}
  b: {material: water, shape: {mesh: asset:knot, scale: 0.1}, spin: [0, 1, 0], color: [0.1, 0.2, 0.3], sample: {pattern: lattice}}
  c: {material: oil, shape: {mesh: asset:knot, fit: {longest: 0.3}, rotate: {axis: x, angle: -90}, center: [0.5, 0.5, 0.5]}, sample: {pattern: poisson}}
  d: {material: jelly, shape: {difference: [{sphere: {radius: 0.2}, center: [0.5, 0.9, 0.6]}, {union: [{cylinder: {radius: 0.1, height: 1}, center: [0.5, 0.9, 0.6]}, {box: {size: [1, 0.1, 0.1]}, center: [0.5, 0.9, 0.6]}]}]}}
colliders:
  ramp: {shape: {plane: {point: [0, 0.1, 0], normal: [0.1, 1, 0]}}, type: stick}
  post: {shape: {cylinder: {radius: 0.05, height: 2}, center: [0.8, 0, 0.5]}, type: slip, friction: 0.2}
  cup: {shape: {sphere: {radius: 0.05}, center: [0.3, 0.5, 0.5]}, thickness: 0.0123, holds: true}
  door: {shape: {box: {size: [0.1, 0.2, 0.3]}, center: [0, 0, 0]}, motion: {keys: [{t: 0.5, position: [1, 2, 3]}, {t: 1, rotate: {axis: [1, 2, 3], angle: 720}}], ease: smooth, about: [0.1, 0, 0]}}
  wheel: {shape: {box: {size: [0.1, 0.2, 0.3]}, center: [0.5, 0.5, 0.5]}, motion: {velocity: [0.1, 0, 0], spin: [0, 0, -2]}}
  mold: {shape: {container: {mesh: asset:knot, fit: {longest: 0.2}, rotate: {axis: y, angle: 20}, wall: 0.0312, open: top, up: [0, -1, 0.1], cut: 0.017, form: shell}, rotate: {axis: z, angle: 5}, center: [0.5, 0.2, 0.6]}}
  bowl: {shape: {container: {union: [{sphere: {radius: 0.1}, center: [0.2, 0.2, 0.5]}, {box: {min: [0.2, 0.1, 0.4], max: [0.4, 0.3, 0.6]}}], wall: 0.02}}}
  tub: {shape: {container: {box: {size: [0.2, 0.1, 0.3]}, wall: 0.02}, center: [0.5, 0.1, 0.6]}}
fields:
  air: {type: drag, rate: 0.1, velocity: [1, 2, 3], box: {min: [0, 0.1, 0], max: [1, 2, 3]}}
  gust: {type: wind, velocity: [1, 0, 0], coefficient: 0.2}
  sun: {type: attractor, point: [1, 2, 3], strength: -4, radius: 0.3}
probes:
  level: {type: height, at: [0.5, 0.6], rate: 240}
  p1: {type: pressure, at: [0, 0.05, 0.5], normal: [1, 0, 0.1], radius: 0.02}
  v: {type: velocity, at: [0.5, 0.2, 0.5], radius: 0.0200000000001}
  fall: {type: flux, plane: {point: [0.4, 0, 0.5], normal: [-1, 0.5, 0]}}
  tank: {type: region, shape: {intersection: [{mesh: asset:knot, scale: 0.2}, {plane: {point: [0, 0.3, 0], normal: [0, 1, 0]}}]}}
  push: {type: force, on: floor}
  lift: {type: force, on: post, rate: 1000}
  front: {type: extent, axis: y, material: oil}
  reach: {type: extent, axis: z}
  tip: {type: point, body: d, at: [0.5, 0.9, 0.6]}
output: {folder: "out/with space", particles: {attributes: [j, pressure]}, checkpoint: {every: 0}}
surface: {voxel: 0.4, smooth: 0, attributes: [age, j], type: sdf, format: obj}
render:
  size: [320, 200]
  samples: 12
  noise: 0.02
  caustics: false
  physical: true
  camera: {from: [2, 1, 2], to: [0.5, 0.3, 0.5], fov: 40}
  light: {sky: studio, sun: {elevation: 50, azimuth: 10, angle: 1, strength: 3}}
  stage: {floor: none, basin: none}
  looks: {water: {type: dielectric, ior: 1.4, absorption: [1, 2, 3]}, stone: {type: spheres, color: [1, 0, 0.5], radius: 0.7}, jelly: {type: opaque, roughness: 0.2}, crate: {type: wood, roughness: 0.3, ring: 0.004, grain: [0, 1, 2]}, ball: {type: metal}, post: {type: plastic, color: [0, 0, 1]}}
  cut: {point: [0, 0, 0.5], normal: [0, 0.1, 1], of: [water, mold]}
video: {quality: 25}
)";

TEST(Emit, ReadsBackAsTheSameScene) {
  const model::Scene d = parsed(everything);
  const std::string text = write_scene(d);
  expect_same(d, parsed(text));
  EXPECT_EQ(write_scene(parsed(text)), text);
  for (const Part p : {Part::simulation, Part::particles, Part::surface, Part::render, Part::video})
    EXPECT_EQ(scene_hash(d, p), scene_hash(parsed(text), p));
  const ParseResult as_model = check_scene(d);
  EXPECT_TRUE(as_model.ok()) << as_model.text();
  expect_same(as_model.scene, d);
  EXPECT_EQ(write_scene(as_model.scene), text);
}

TEST(Emit, AnotherSurfaceFormatIsTheSameMesh) {
  model::Scene d = parsed(everything);
  const std::string surface = scene_hash(d, Part::surface), render = scene_hash(d, Part::render);
  d.surface.format = model::SurfaceFormat::ply;
  EXPECT_EQ(scene_hash(d, Part::surface), surface);
  d.surface.type = model::SurfaceType::fog;
  EXPECT_EQ(scene_hash(d, Part::surface), surface);
  EXPECT_EQ(scene_hash(d, Part::render), render);
  d.surface.smooth = 1;
  EXPECT_NE(scene_hash(d, Part::surface), surface);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return text;
}

TEST(Emit, TheFormatVdbOfEarlierVersionsIsTheTypeFog) {
  const model::Scene d = parsed(replaced(everything, "type: sdf, format: obj", "format: vdb"));
  EXPECT_EQ(d.surface.type, model::SurfaceType::fog);
  EXPECT_EQ(d.surface.format, model::SurfaceFormat::ply);
  EXPECT_NE(write_scene(d).find("type: fog"), std::string::npos);
}

TEST(Emit, OtherAttributesOfSurfacesAreOtherMeshesAndMayNeedOtherParticles) {
  model::Scene d = parsed(everything);
  d.surface.attributes = {"velocity"};
  const auto hashes = [&] { return std::pair{scene_hash(d, Part::particles), scene_hash(d, Part::surface)}; };
  const auto [particles, surface] = hashes();
  d.surface.attributes = {"velocity", "vorticity"};
  EXPECT_EQ(hashes().first, particles) << "it is made of the velocities";
  EXPECT_NE(hashes().second, surface);
  d.surface.attributes = {"velocity", "age"};
  EXPECT_NE(hashes().first, particles) << "files of particles get an age";
  d.surface.attributes = {"velocity", "color"};
  const std::string colored = hashes().second;
  d.bodies[0].color = Vec3d{0.5, 0.25, 0.125};
  EXPECT_NE(hashes().second, colored) << "another color of a body";
}

TEST(Emit, EveryShippedSceneReadsBack) {
  for (const auto& f : std::filesystem::directory_iterator(std::filesystem::path(DM_SOURCE_DIR) / "scenes")) {
    if (f.path().extension() != ".yaml") continue;
    const model::Scene d = load_scene(f.path(), {.variant = "preview", .overrides = {}});
    expect_same(d, parsed(write_scene(d)));
  }
}

/// The parts whose hash an override changes, as letters: s p u r v.
std::string changed(const std::string& override_) {
  const ParseResult before = parse_scene_text(everything, "scene.yaml");
  const ParseResult after = parse_scene_text(everything, "scene.yaml", {.variant = "", .overrides = {override_}});
  EXPECT_TRUE(after.ok()) << after.text();
  std::string letters;
  for (const auto& [part, letter] :
       {std::pair{Part::simulation, 's'}, std::pair{Part::particles, 'p'}, std::pair{Part::surface, 'u'},
        std::pair{Part::render, 'r'}, std::pair{Part::video, 'v'}})
    if (scene_hash(before.scene, part) != scene_hash(after.scene, part)) letters += letter;
  return letters;
}

TEST(Hash, AChangedKeyRedoesOnlyWhatItMust) {
  EXPECT_EQ(changed("space.spacing=0.02"), "spurv");
  EXPECT_EQ(changed("materials.water.relaxation=1"), "spurv");
  EXPECT_EQ(changed("bodies.a.velocity=[1, 2, 3.0000000001]"), "spurv");
  EXPECT_EQ(changed("seed=2"), "spurv");
  EXPECT_EQ(changed("fields.sun.strength=-5"), "spurv");
  EXPECT_EQ(changed("gravity=[0, 0, 0]"), "spurv");
  EXPECT_EQ(changed("output.particles.attributes=[velocity, j]"), "p");
  EXPECT_EQ(changed("probes.level.rate=24"), "p") << "nothing that is computed from particles";
  EXPECT_EQ(changed("probes.push.on=x_min"), "p");
  EXPECT_EQ(changed("probes.new={type: height, at: [0.5, 0.5]}"), "p");
  EXPECT_EQ(changed("surface.voxel=0.5"), "urv");
  EXPECT_EQ(changed("bodies.b.color=[1, 1, 1]"), "rv");
  EXPECT_EQ(changed("render.looks.water.ior=1.5"), "rv");
  EXPECT_EQ(changed("render.cut={point: [0, 0, 0.1], normal: [0, 0, 1], of: [water]}"), "rv");
  EXPECT_EQ(changed("video.quality=20"), "v");
  EXPECT_EQ(changed("time.frames=99"), "") << "more frames continue a run";
  EXPECT_EQ(changed("output.folder=elsewhere"), "");
  EXPECT_EQ(changed("space.max=[1.0500001, 1.2, 0.9]"), "") << "rounded up to the same walls";
}

TEST(Hash, SeesTheBytesOfAMeshAndNotItsPlace) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(DM_BINARY_DIR) / "scene_hash_test";
  make_folder(folder / "other");
  const auto hash_of = [&](const char* file, const char* bytes) {
    replace_file_text(folder / file, bytes);
    const std::string text = fmt::format(
        "dreampm: 1\nname: m\nspace: {{max: [1, 1, 1], spacing: 0.02}}\nmaterials: {{w: {{type: newtonian}}}}\n"
        "bodies: {{m: {{material: w, shape: {{mesh: {}}}}}}}\n",
        file);
    const ParseResult r = parse_scene_text(text, (folder / "scene.yaml").string());
    EXPECT_TRUE(r.ok()) << r.text();
    return scene_hash(r.scene, Part::simulation);
  };
  const std::string one = hash_of("a.ply", "one");
  EXPECT_EQ(one, hash_of("other/b.ply", "one"));
  EXPECT_NE(one, hash_of("a.ply", "two"));
}

}  // namespace
}  // namespace dreampm::scene
