// dreampm bench with a backend that has a device, as it is typed; a library stands in for the card.
#include <cli/typed.h>
#include <gmock/gmock.h>

namespace dreampm::test {
namespace {
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class BenchBackend : public Typing {
 protected:
  /// The line where that number of the stand-in's devices is chosen: 1 is full.
  Typed with_card(const std::string& line, int number = 0) const {
    return type(line, "export DREAMPM_CUDA='" STAND_IN "' DREAMPM_STAND_IN=" + std::to_string(number));
  }
  const std::string quick = " --windows 1 --seconds 0.001";
};

TEST_F(BenchBackend, AStepNamesBackendAndDevice) {
  const std::string line = "bench step --backend cuda --cells 8 8 4 --material snow" + quick;
  Typed t = with_card(line + " --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json all = json::parse(t.out), &r = all.at("results").at(0);
  EXPECT_THAT(all.at("device").get<std::string>(), HasSubstr("Stand-in"));
  EXPECT_EQ(all.count("ceilings"), 0u) << "of processors";
  EXPECT_EQ(r.at("backend"), "cuda");
  EXPECT_EQ(r.at("isa"), "sm_90");
  EXPECT_EQ(r.at("particles"), 8 * 8 * 8 * 4);
  EXPECT_GT(r.at("mps").get<double>(), 0);
  EXPECT_NEAR(r.at("steps_per_sort").get<double>(), 18, 5) << "it moves as on cpu";
  EXPECT_GE(r.at("device_memory_per_particle").get<double>(), 0);
  t = with_card(line);
  EXPECT_THAT(t.out, AllOf(StartsWith("step, snow, 2,048 particles, "), HasSubstr(", cuda sm_90: "),
                           HasSubstr("Stand-in"), testing::Not(HasSubstr("ceilings"))));
  t = type("bench step --backend cpu --isa sse4 --cells 4 4 4" + quick);
  EXPECT_THAT(t.out, AllOf(HasSubstr(", 1 thread, cpu sse4: "), HasSubstr("ceilings")));
}

TEST_F(BenchBackend, TapsAndEditsAreMeasuredThereToo) {
  Typed t = with_card("bench step --backend cuda --cells 4 4 4 --sink --edit --json" + quick);
  ASSERT_EQ(t.code, 0) << t.err;
  json rows = json::parse(t.out).at("results");
  EXPECT_EQ(rows.size(), 6u);
  t = with_card("bench edits --backend cuda --particles 1000 --faces 200 --rounds 2 --json");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(json::parse(t.out).at("device").get<std::string>(), HasSubstr("Stand-in"));
  for (const json& r : json::parse(t.out).at("results")) rows.push_back(r);
  for (const json& r : rows) {
    EXPECT_EQ(r.at("backend"), "cuda") << r;
    EXPECT_EQ(r.at("isa"), "sm_90") << r;
  }
}

TEST_F(BenchBackend, TheTableOfADeviceHasItsOwnRows) {
  const Typed t = with_card("bench all --backend cuda --largest 8192" + quick);
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, StartsWith("Stand-in"));
  EXPECT_THAT(t.out, AllOf(HasSubstr("| newtonian | 8,192 | cuda | sm_90 | "), HasSubstr("| snow | 8,192 | cuda | "),
                           testing::Not(HasSubstr("65,536")), HasSubstr(" GB/s")));
}

TEST_F(BenchBackend, RefusesWhatDoesNotGoTogether) {
  const auto refuses = [&](const std::string& line, const std::string& words) {
    const Typed t = with_card(line);
    EXPECT_EQ(t.code, 2) << line << ": " << t.err;
    EXPECT_THAT(t.err, HasSubstr(words)) << line;
    EXPECT_EQ(t.out, "") << line;
  };
  refuses("bench step --backend cuda --isa avx2", "--isa avx2: --backend cuda has no instruction sets");
  refuses("bench edits --backend gpu", "--backend");
  refuses("bench step --backend reference", "--backend reference: it computes in double");
  refuses("bench step --backend cuda --solver projection", "leave --backend cuda out");
  refuses("bench step --backend cuda --solver projection --sink", "leave --backend cuda out");
  refuses("bench all --backend cuda --shrink 2", "--shrink: not with --backend cuda");
  refuses("bench all --backend cuda --isa sse4", "--isa: not with --backend cuda");
  refuses("bench all --largest 70000", "--largest: not with --backend cpu");
  refuses("bench all --backend reference", "--backend reference: it has no device");
  const Typed none = type("bench step --backend cuda", "export DREAMPM_CUDA=/nowhere/libdreampm_cuda.so");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("no CUDA"));
  const Typed full = with_card("bench step --backend cuda --cells 4 4 4" + quick, 1);
  EXPECT_EQ(full.code, 1);
  EXPECT_THAT(full.err, HasSubstr("no room for"));
}

TEST_F(BenchBackend, TheDeviceTellsItsMemory) {
  const json device = json::parse(with_card("info --device --json").out);
  EXPECT_EQ(device.at("free_bytes"), 1u << 29);
  EXPECT_EQ(device.at("memory_bytes"), 1u << 30);
}

}  // namespace
}  // namespace dreampm::test
