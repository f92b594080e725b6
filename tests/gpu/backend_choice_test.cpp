// Which backend computes, as a user meets it: a run that goes from one to another and back, the
// verbs that take --backend, snapshots, and the playground. A stand-in is the card.
#include <cli/typed.h>
#include <gmock/gmock.h>
#include <simulation/scenes.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/io/ledger.h"
#include "dreampm/io/ply.h"
#include "dreampm/simulation.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The largest distance of particles of the same id [m].
double apart(const ParticleFrame& a, const ParticleFrame& b) {
  EXPECT_EQ(a.id, b.id);
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.position.size(), b.position.size()); ++i)
    largest = std::max(largest, static_cast<double>(length(a.position[i] - b.position[i])));
  return largest;
}

class BackendChoice : public Typing {
 protected:
  static constexpr double spacing = 0.02;

  void SetUp() override {
    Typing::SetUp();
    write("dam.yaml",
          "dreampm: 1\nname: dam\nspace: {max: [0.4, 0.24, 0.2], spacing: 0.02}\ntime: {fps: 50, frames: 9}\n"
          "materials:\n  water: {type: newtonian}\n  jelly: {type: elastic, preset: jelly, transfer: asflip}\n"
          "bodies:\n  dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.16, 0.16, 0.2]}}}\n"
          "  cube: {material: jelly, shape: {box: {size: [0.08, 0.08, 0.08]}, center: [0.3, 0.1, 0.1]}}\n"
          "colliders: {ball: {shape: {sphere: {radius: 0.04}, center: [0.3, 0.03, 0.1]}, type: separate}}\n"
          "probes: {level: {type: height, at: [0.05, 0.1]}}\n"
          "output: {checkpoint: {every: 1}}\n");
  }
  Typed with_card(const std::string& line) const { return type(line, "export DREAMPM_CUDA='" STAND_IN "'"); }
  Typed without(const std::string& line) const { return type(line, "export DREAMPM_CUDA=/nowhere.so"); }
  ParticleFrame last_frame(const std::string& run) const {
    return read_particles(folder / run / "particles/particles_000009.ply");
  }
  std::vector<std::string> hashes(const std::string& run) const {
    std::vector<std::string> all;
    const nlohmann::json whole = record(run);
    for (const auto& frame : whole.at("frames")) all.push_back(frame.at("state_hash"));
    return all;
  }
};

TEST_F(BackendChoice, ARunGoesFromOneToAnotherAndBack) {
  ASSERT_EQ(with_card("run dam.yaml --out by-cuda --backend cuda").code, 0);
  ASSERT_EQ(without("run dam.yaml --out by-cpu").code, 0);
  EXPECT_FALSE(record("by-cpu").contains("earlier_backends"));
  ASSERT_EQ(with_card("run dam.yaml --out parts --backend cuda --frames 3 --strict").code, 0);
  Typed t = without("run dam.yaml --out parts --resume --backend cpu --frames 6 --strict");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err,
              AllOf(HasSubstr("cpu ("), HasSubstr("goes on with what cuda (sm_90) computed: the same to rounding")));
  EXPECT_EQ(record("parts").at("backend"), "cpu");
  t = with_card("run dam.yaml --out parts --resume --backend cuda --strict");
  ASSERT_EQ(t.code, 0) << t.err;

  const nlohmann::json parts = record("parts");
  EXPECT_EQ(parts.at("backend"), "cuda");
  ASSERT_EQ(parts.at("earlier_backends").size(), 2u);
  EXPECT_EQ(parts["earlier_backends"][0].dump(), R"({"backend":"cuda","isa":"sm_90","last_frame":3})");
  EXPECT_EQ(parts["earlier_backends"][1]["backend"], "cpu");
  EXPECT_EQ(parts["earlier_backends"][1]["last_frame"], 6);
  EXPECT_THAT(with_card("info parts").out, HasSubstr("cuda (sm_90) to frame 3, cpu ("));
  EXPECT_THAT(read_file(folder / "parts/log.txt"), HasSubstr("cuda (sm_90) goes on with what cpu ("));

  // No farther from either than these are from each other, as far as rounding is the same thing.
  const ParticleFrame cuda = last_frame("by-cuda"), cpu = last_frame("by-cpu"), both = last_frame("parts");
  const double usual = apart(cuda, cpu);
  std::printf("cpu and cuda lie %.3g spacings apart, the run of both %.3g and %.3g\n", usual / spacing,
              apart(both, cpu) / spacing, apart(both, cuda) / spacing);
  EXPECT_GT(usual, 0);
  EXPECT_LT(usual, 0.02 * spacing);
  EXPECT_LT(apart(both, cuda), 0.02 * spacing);
  EXPECT_LT(apart(both, cpu), 0.02 * spacing);
  const Ledger whole = read_ledger(folder / "by-cuda/ledger.csv"), pieced = read_ledger(folder / "parts/ledger.csv");
  ASSERT_EQ(pieced.rows.size(), 9u);
  for (std::size_t f = 0; f < 9; ++f) {
    EXPECT_EQ(pieced.rows[f].frame, static_cast<int>(f) + 1);
    EXPECT_NEAR(pieced.rows[f].kinetic, whole.rows[f].kinetic, 1e-3 * whole.rows[8].kinetic) << f;
  }
  const std::string level = read_file(folder / "parts/probes/level.csv");
  EXPECT_EQ(std::count(level.begin(), level.end(), '\n'), 1 + 9) << "a head, and a row a frame";
}

TEST_F(BackendChoice, AProjectionSaysThatItIsTheProcessors) {
  const std::string wanted = "dam.yaml: time.solver: projection computes on the processor, with the backend cuda too";
  const std::string line = "run dam.yaml --frames 1 --overwrite --set materials.jelly.transfer=apic --set time.solver=";
  EXPECT_THAT(with_card(line + "projection --backend cuda").err, HasSubstr(wanted));
  EXPECT_THAT(with_card(line + "projection").err, Not(HasSubstr("on the processor")));
  EXPECT_THAT(with_card(line + "explicit --backend cuda").err, Not(HasSubstr("on the processor")));
}

TEST_F(BackendChoice, WithoutAWordItGoesOnByTheSameOneToTheBit) {
  ASSERT_EQ(with_card("run dam.yaml --out whole --backend cuda").code, 0);
  ASSERT_EQ(with_card("run dam.yaml --out parts --backend cuda --frames 4").code, 0);
  // Not here: nothing goes on in silence by another.
  const Typed refused = without("run dam.yaml --out parts --resume");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("no CUDA: /nowhere.so"), HasSubstr("was computed by cuda (sm_90)"),
                                 HasSubstr("run --resume"), HasSubstr("--backend")));
  EXPECT_EQ(hashes("parts").size(), 4u);
  const Typed t = with_card("run dam.yaml --out parts --resume");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, Not(HasSubstr("to rounding")));
  EXPECT_EQ(hashes("parts"), hashes("whole"));
  EXPECT_FALSE(record("parts").contains("earlier_backends"));
  const Typed with_isa = with_card("run dam.yaml --out other --backend cuda --isa sse4");
  EXPECT_EQ(with_isa.code, 2);
  EXPECT_THAT(with_isa.err, HasSubstr("sse4 is one of the backend cpu"));
  EXPECT_FALSE(fs::exists(folder / "other"));
  // Nor by another instruction set.
  ASSERT_EQ(without("run dam.yaml --out sets --frames 3 --isa sse4").code, 0);
  ASSERT_EQ(without("run dam.yaml --out sets --frames 4 --resume").code, 0);
  EXPECT_EQ(record("sets").at("machine").at("isa"), "sse4");
  for (const std::string_view set : cpu_instruction_sets())
    if (set != "sse4") {
      const Typed other = without("run dam.yaml --out sets --frames 5 --resume --isa " + std::string(set));
      EXPECT_EQ(other.code, 0) << other.err;
      EXPECT_THAT(other.err, HasSubstr("goes on with what cpu (sse4) computed: the same to rounding"));
      EXPECT_EQ(record("sets").at("earlier_backends")[0].dump(), R"({"backend":"cpu","isa":"sse4","last_frame":4})");
      break;
    }
  const Typed in_double = with_card("run dam.yaml --out parts --resume --backend reference");
  EXPECT_EQ(in_double.code, 2);
  EXPECT_THAT(in_double.err, AllOf(HasSubstr("checkpoint_000009.h5: is in float"), HasSubstr("--backend cuda")));
}

TEST_F(BackendChoice, BackToAnEarlierCheckpointIsBackToItsBackend) {
  ASSERT_EQ(without("run dam.yaml --out run --frames 3").code, 0);
  ASSERT_EQ(with_card("run dam.yaml --out run --resume --backend cuda --frames 4").code, 0);
  fs::remove(folder / "run/checkpoint/checkpoint_000004.h5");
  ASSERT_EQ(without("run dam.yaml --out run --resume").code, 0);
  ASSERT_EQ(without("run dam.yaml --out straight").code, 0);
  EXPECT_EQ(hashes("run"), hashes("straight"));
  EXPECT_FALSE(record("run").contains("earlier_backends"));
}

TEST_F(BackendChoice, MakeMakesWithItAndKeepsIt) {
  const std::string only = "make dam.yaml --out film --only simulate";
  ASSERT_EQ(with_card(only + " --backend cuda").code, 0);
  EXPECT_EQ(record("film").at("backend"), "cuda");
  // What is whole needs no card.
  EXPECT_THAT(without(only).err, HasSubstr("nothing to do"));
  EXPECT_THAT(without(only + " --backend cuda").err, HasSubstr("nothing to do"));
  Typed t = without(only + " --set gravity=[0,-5,0]");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, AllOf(HasSubstr("simulate: the scene changed: starts again\n"),
                           HasSubstr("simulate: by the backend cpu; the run before was by cuda\n")));
  t = with_card(only + " --set gravity=[0,-5,0] --backend cuda");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("simulate: the backend changed: starts again\n"));
  EXPECT_EQ(record("film").at("backend"), "cuda");
}

TEST_F(BackendChoice, FarmsWedgesAndCasesTakeIt) {
  ASSERT_EQ(without("farm dam.yaml --to slurm --out job --backend cuda").code, 0) << "written where there is none";
  EXPECT_THAT(read_file(folder / "job/slurm.sh"), HasSubstr("--only simulate --out . --backend cuda'"));
  ASSERT_EQ(without("wedge dam.yaml gravity=[0,-5,0],[0,-9,0] --to make --out jobs --backend cuda").code, 0);
  EXPECT_THAT(read_file(folder / "jobs/Makefile"), HasSubstr("--backend cuda"));
  const Typed t = with_card("validate free-fall --backend cuda --json");
  EXPECT_EQ(t.code, 0) << t.err;
  const nlohmann::json fall = nlohmann::json::parse(t.out).at("cases")[0];
  EXPECT_EQ(fall.at("backend"), "cuda");
  EXPECT_EQ(fall.at("metrics")[1].at("name"), "cuda (float): farthest from it");
  EXPECT_THAT(without("validate free-fall --backend cuda").err, HasSubstr("no CUDA"));
  EXPECT_THAT(without("validate free-fall --backend reference").err, HasSubstr("computes in double"));
}

TEST_F(BackendChoice, SnapshotsAndMomentsGoFromOneToAnother) {
  ASSERT_EQ(setenv("DREAMPM_CUDA", STAND_IN, 1), 0);
  Simulation cpu(dam_and_jelly("asflip"), quiet(1)), cuda(dam_and_jelly("asflip"), quiet(1, "cuda")),
      reference(dam_and_jelly("asflip"), quiet(1, "reference"));
  EXPECT_EQ(cuda.backend(), "cuda");
  cuda.advance_frames(1);
  cuda.set_gravity({1, -9, 0});
  cuda.add_particles("water", std::vector<Vec3d>{{0.1, 0.17, 0.08}}, {0, -1, 0});
  const Snapshot then = cuda.snapshot();
  cpu.restore(then);
  EXPECT_EQ(cpu.particles("water").id.size(), cuda.particles("water").id.size());
  EXPECT_EQ(cpu.gravity().x, 1);
  const auto same_places = [&](double tolerance) {
    for (const char* material : {"water", "jelly"}) {
      const ParticleView a = cpu.particles(material), b = cuda.particles(material);
      ASSERT_EQ(a.id.size(), b.id.size());
      double largest = 0;
      for (std::size_t i = 0; i < a.id.size(); ++i)
        largest = std::max(largest, static_cast<double>(length(a.position[i] - b.position[i])));
      EXPECT_LE(largest, tolerance) << material;
    }
  };
  same_places(0);
  cpu.advance_frames(1), cuda.advance_frames(1);
  same_places(0.02 * cpu.scene().spacing());
  // And back, where the backend's own bits come again.
  const std::uint64_t future = cuda.hash();
  cuda.restore(cpu.snapshot());
  same_places(0);
  cuda.advance_frames(1);
  cuda.restore(then);
  cuda.advance_frames(1);
  EXPECT_EQ(cuda.hash(), future);
  try {
    reference.restore(then);
    ADD_FAILURE() << "float is not double";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("of the backend cuda"), HasSubstr("precision of reference")));
  }
  // What one saves, another goes on from.
  cuda.save(folder / "moment.yaml");
  Simulation on(load_scene(folder / "moment.yaml"), quiet(1, "cpu"));
  EXPECT_EQ(on.frame(), cuda.frame());
  EXPECT_EQ(on.particle_count(), cuda.particle_count());
  on.advance_frames(1);
}

}  // namespace
}  // namespace dreampm::test
