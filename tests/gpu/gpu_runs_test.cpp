// Whole scenes by the kernels of a device, on the host, against the reference in double: everything
// that a scene may hold. The ledger closes in each.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include <simulation/scenes.h>
#include "dreampm/base/host.h"
#include "dreampm/io/ledger.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {
using namespace test;
namespace fs = std::filesystem;

/// A scene of one kind of matter or surroundings, and how long it runs.
struct Case {
  const char* name;
  const char* rest;  ///< of the scene's text, after its head
  int frames = 6;
  double apart = 0.03;     ///< of the kinetic energy and the number of particles
  const char* space = "";  ///< more keys of `space`
  const char* time = "";   ///< more keys of `time`
  bool staged = false;     ///< whether viscosity acts in stages
};
constexpr const char* dam_and_colliders = R"(
materials: {water: {type: newtonian}}
bodies: {dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.08, 0.14, 0.16]}}}}
colliders:
  ball: {shape: {sphere: {radius: 0.05}, center: [0.12, 0.02, 0.08]}, type: stick}
  block: {shape: {box: {size: [0.08, 0.1, 0.2]}, center: [0.21, 0.05, 0.08]}, type: slip, motion: {velocity: [-0.3, 0, 0]}}
)";
constexpr Case cases[] = {
    {"honey, whose viscosity is sub-cycled, from a tap into a pool", R"(
materials: {honey: {type: newtonian, viscosity: 1000, density: 1400, bulk_modulus: 1.0e5}}
bodies: {pool: {material: honey, shape: {box: {min: [0, 0, 0], max: [0.24, 0.06, 0.16]}}, cut: [ball]}}
emitters:
  tap: {material: honey, shape: {cylinder: {radius: 0.03, height: 0.02}, center: [0.12, 0.16, 0.08]}, velocity: [0, -0.8, 0], start: 0.02, pool: 4000}
colliders: {ball: {shape: {sphere: {radius: 0.04}, center: [0.12, 0.02, 0.08]}}}
)",
     6, 0.03, ", walls: {all: {type: separate, skin_friction: true}}", ", damping: 1", true},
    {"snow and sand between walls of all kinds, damped", R"(
materials: {snow: {type: snow}, sand: {type: sand, youngs_modulus: 1.0e5}}
bodies:
  ball: {material: snow, shape: {sphere: {radius: 0.05}, center: [0.08, 0.08, 0.06]}, velocity: [-1, -1, -0.5]}
  heap: {material: sand, shape: {box: {min: [0.13, 0, 0.04], max: [0.22, 0.08, 0.14]}}, velocity: [1, 0, 0]}
)",
     6, 0.03,
     ", walls: {x_min: {type: stick}, x_max: {friction: 0.4}, y_min: {type: slip, friction: 0.2}, z_min: {type: slip}, "
     "z_max: {type: open}}",
     ", damping: 2"},
    {"water that keeps velocities along walls with boundary layers", R"(
materials: {water: {type: newtonian, viscosity: 0.2, transfer: flip, flip_memory: 0.03}}
bodies: {dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.1, 0.12, 0.16]}}}}
)",
     6, 0.03, ", walls: {all: {type: separate, skin_friction: true}, x_max: {type: stick}}"},
    {"two liquids of two densities", R"(
materials: {oil: {type: newtonian, density: 800}, water: {type: newtonian, density: 1000}}
bodies:
  above: {material: oil, shape: {box: {min: [0, 0.06, 0], max: [0.1, 0.12, 0.16]}}}
  below: {material: water, shape: {box: {min: [0, 0, 0], max: [0.1, 0.06, 0.16]}}}
)"},
    {"jelly in water, which keeps velocities", R"(
materials:
  water: {type: newtonian, transfer: flip, flip_memory: 0.03}
  jelly: {type: neo_hookean, density: 600, youngs_modulus: 2.0e4, poissons_ratio: 0.3, transfer: asflip}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.24, 0.06, 0.16]}}}
  cube: {material: jelly, shape: {box: {min: [0.06, 0.08, 0.04], max: [0.14, 0.16, 0.12]}}, velocity: [1, -1, 0]}
)"},
    {"sand over a ball, and a thin plate that moves", R"(
materials: {sand: {type: sand, youngs_modulus: 1.0e5}}
bodies: {heap: {material: sand, shape: {box: {min: [0.04, 0.1, 0.04], max: [0.14, 0.18, 0.12]}}}}
colliders:
  ball: {shape: {sphere: {radius: 0.04}, center: [0.1, 0.04, 0.08]}, type: separate, friction: 0.4}
  plate: {shape: {box: {size: [0.02, 0.14, 0.16]}, center: [0.2, 0.07, 0.08]}, type: slip, motion: {velocity: [-0.3, 0, 0]}}
)"},
    {"snow and sand over a ball, in front of a block that moves", R"(
materials: {snow: {type: snow}, sand: {type: sand, youngs_modulus: 1.0e5}}
bodies:
  heap: {material: sand, shape: {box: {min: [0.04, 0.1, 0.04], max: [0.14, 0.16, 0.12]}}}
  roof: {material: snow, shape: {box: {min: [0.04, 0.16, 0.04], max: [0.14, 0.2, 0.12]}}}
colliders:
  ball: {shape: {sphere: {radius: 0.04}, center: [0.1, 0.04, 0.08]}, type: separate, friction: 0.4}
  block: {shape: {box: {size: [0.08, 0.1, 0.2]}, center: [0.21, 0.05, 0.08]}, type: slip, motion: {velocity: [-0.3, 0, 0]}}
)"},
    {"jelly in honey, whose viscosity is sub-cycled, over a ball that moves", R"(
materials:
  honey: {type: newtonian, viscosity: 1000, density: 1400, bulk_modulus: 1.0e5}
  jelly: {type: elastic, density: 2500, youngs_modulus: 2.0e4, poissons_ratio: 0.3}
bodies:
  pool: {material: honey, shape: {box: {min: [0, 0, 0], max: [0.24, 0.1, 0.16]}}, cut: [ball]}
  cube: {material: jelly, shape: {box: {min: [0.06, 0.11, 0.04], max: [0.16, 0.18, 0.12]}}, velocity: [0, -2, 0]}
colliders: {ball: {shape: {sphere: {radius: 0.05}, center: [0.12, 0.02, 0.08]}, motion: {velocity: [0.3, 0, 0]}}}
fields: {pull: {type: attractor, point: [0.2, 0.1, 0.08], strength: 0.2, radius: 0.05}}
)",
     6, 0.03, ", walls: {all: {type: separate, skin_friction: true}}", ", damping: 1", true},
    {"water over edges, sand on what holds it by tension, all around a periodic box", R"(
materials: {water: {type: newtonian}, sand: {type: sand, youngs_modulus: 1.0e5}}
bodies:
  dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.08, 0.14, 0.15]}}, velocity: [1, 0, 0.5]}
  heap: {material: sand, shape: {box: {min: [0.15, 0.11, 0.04], max: [0.22, 0.16, 0.12]}}, velocity: [-0.5, 0, 0]}
colliders:
  step: {shape: {box: {size: [0.05, 0.07, 0.6]}, center: [0.14, 0.035, 0.08]}, type: separate, friction: 0.3}
  shelf: {shape: {box: {size: [0.1, 0.06, 0.6]}, center: [0.2, 0.08, 0.08]}, type: separate, sticky: 2000}
)",
     6, 0.03, ", periodic: [z]"},
    {"jelly that a collider holds and another one strikes", R"(
materials: {jelly: {type: elastic, youngs_modulus: 2.0e4, poissons_ratio: 0.3}}
bodies: {bar: {material: jelly, shape: {box: {min: [0.02, 0.08, 0.04], max: [0.2, 0.13, 0.12]}}}}
colliders:
  clamp: {shape: {box: {size: [0.06, 0.1, 0.16]}, center: [0.04, 0.1, 0.08]}, holds: true, motion: {velocity: [0, 0.2, 0]}}
  fist: {shape: {sphere: {radius: 0.04}, center: [0.16, 0.2, 0.08]}, type: separate, friction: 0.2, motion: {velocity: [0, -1, 0]}}
)"},
    {"force fields of all kinds over water and jelly", R"(
materials:
  water: {type: newtonian}
  jelly: {type: elastic, density: 1500, youngs_modulus: 2.0e4, poissons_ratio: 0.3}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.16, 0.08, 0.16]}}}
  cube: {material: jelly, shape: {box: {min: [0.06, 0.09, 0.04], max: [0.14, 0.16, 0.12]}}, velocity: [0, -1, 0]}
fields:
  pull: {type: attractor, point: [0.2, 0.1, 0.08], strength: 0.1, radius: 0.05}
  gust: {type: wind, velocity: [3, 0, 0], coefficient: 2, box: {min: [0, 0.05, 0], max: [0.24, 0.2, 0.16]}}
  slow: {type: drag, rate: 3, velocity: [0, 0, 0.5]}
  hand: {type: brush, point: [0.08, 0.06, 0.08], radius: 0.05, velocity: [0, 1, 0], rate: 50}
)"},
    {"water over a ball, in front of a block that moves", dam_and_colliders},
    {"the same by contact at nodes alone", dam_and_colliders, 6, 0.03, "", ", surface_contact: false"},
    {"a box that floats", R"(
materials: {water: {type: newtonian}}
bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.24, 0.08, 0.16]}}}}
rigid: {box: {shape: {box: {size: [0.08, 0.06, 0.08]}, center: [0.12, 0.11, 0.08]}, density: 500}}
)"},
    {"a ball and a box in water, and sand on the box, around a periodic box", R"(
materials: {water: {type: newtonian}, sand: {type: sand, youngs_modulus: 1.0e5}}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.25, 0.08, 0.16]}}, velocity: [0.5, 0, 0], cut: [ball, box]}
  heap: {material: sand, shape: {box: {min: [0.05, 0.13, 0.05], max: [0.11, 0.17, 0.11]}}}
rigid:
  ball: {shape: {sphere: {radius: 0.035}, center: [0.235, 0.09, 0.08]}, density: 600}
  box: {shape: {box: {size: [0.09, 0.04, 0.09]}, center: [0.08, 0.09, 0.08]}, density: 500}
)",
     6, 0.03, ", periodic: [x]"},
    {"a box that falls into honey, whose viscosity is sub-cycled", R"(
materials: {honey: {type: newtonian, viscosity: 1000, density: 1400, bulk_modulus: 1.0e5}}
bodies: {pool: {material: honey, shape: {box: {min: [0, 0, 0], max: [0.24, 0.08, 0.16]}}}}
rigid: {box: {shape: {box: {size: [0.06, 0.06, 0.06]}, center: [0.12, 0.11, 0.08]}, density: 5000}}
)",
     6, 0.06, "", "", true},  // in float and double, too, such a fall differs by some percent
    {"a tap, a drain and probes", R"(
materials: {water: {type: newtonian}}
emitters:
  tap: {material: water, shape: {cylinder: {radius: 0.03, height: 0.02}, center: [0.12, 0.17, 0.08]}, velocity: [0, -1.5, 0], pool: 4000}
sinks: {drain: {shape: {box: {min: [0.06, 0, 0], max: [0.18, 0.03, 0.16]}}}}
probes:
  push: {type: pressure, at: [0.12, 0, 0.08], normal: [0, 1, 0], radius: 0.05, rate: 120}
  flow: {type: velocity, at: [0.12, 0.1, 0.08], radius: 0.05}
)",
     10, 0.06},  // a drain takes when particles are sorted, which nobody promises to be at the same step
    {"a tap alone, which begins with no matter", R"(
materials: {water: {type: newtonian}}
emitters:
  tap: {material: water, shape: {cylinder: {radius: 0.03, height: 0.02}, center: [0.12, 0.17, 0.08]}, velocity: [0, -1.5, 0], start: 0.01, pool: 4000}
)",
     8},
    {"jelly in water of large steps", R"(
materials:
  water: {type: newtonian}
  jelly: {type: elastic, density: 1500, youngs_modulus: 2.0e4, poissons_ratio: 0.3}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.24, 0.08, 0.16]}}}
  cube: {material: jelly, shape: {box: {min: [0.06, 0.09, 0.04], max: [0.14, 0.16, 0.12]}}, velocity: [0, -1, 0]}
)",
     6, 0.03, "", ", solver: projection"},
    {"snow that falls through a periodic box, in a wind", R"(
materials: {snow: {type: snow}}
bodies: {ball: {material: snow, shape: {sphere: {radius: 0.05}, center: [0.2, 0.12, 0.08]}, velocity: [2, -1, 0]}}
fields: {wind: {type: wind, velocity: [3, 0, 0], coefficient: 2}}
)",
     6, 0.03, ", periodic: [x]"},
};

std::string text_of(const Case& one) {
  return std::string("dreampm: 1\nname: case\nspace: {min: [0, 0, 0], max: [0.24, 0.2, 0.16], spacing: 0.0125") +
         one.space + "}\ntime: {fps: 50, frames: " + std::to_string(one.frames) + one.time + "}\n" + one.rest;
}

/// The last row of a run's ledger, which has to close.
LedgerRow last_row(const Case& one, const std::string& backend) {
  const auto parsed = scene::parse_scene_text(text_of(one), "case.yaml", {});
  if (!parsed.ok()) throw std::runtime_error(parsed.text());
  const fs::path folder = fs::path(DM_BINARY_DIR) / "test-files" / "gpu" / backend;
  fs::remove_all(folder);
  SimulateOptions options;
  options.folder = folder, options.backend = backend, options.strict = true;
  SilentHost host;
  const HostScope scope(&host);
  simulate(parsed.scene, {"case.yaml", {}}, options);
  return read_ledger(folder / "ledger.csv").rows.back();
}

TEST(GpuRuns, FollowTheReferenceAndTheLedgerCloses) {
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    const LedgerRow want = last_row(one, "reference");
    for (const char* backend : {"gpu", "cpu"}) {
      const LedgerRow got = last_row(one, backend);
      std::printf("%s: by %s %.0f particles, kinetic energy %.6g J, in the reference %.6g J\n", one.name, backend,
                  got.particles, got.kinetic, want.kinetic);
      EXPECT_GT(got.particles, 150);
      EXPECT_NEAR(got.particles, want.particles, one.apart * want.particles);
      EXPECT_NEAR(got.kinetic, want.kinetic, one.apart * want.kinetic);
      EXPECT_NEAR(got.work, want.work, one.apart * std::abs(want.work) + 1e-9);
      EXPECT_NEAR(got.j_min, want.j_min, 0.02);
      EXPECT_EQ(got.stages > 0, one.staged);
    }
  }
}

}  // namespace
}  // namespace dreampm
