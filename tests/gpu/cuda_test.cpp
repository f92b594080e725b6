// The library that is loaded at run time, as a user meets it: by the command, with a stand-in for a
// card, and with what is missing or does not fit.
#include <cli/typed.h>
#include <gmock/gmock.h>

namespace dreampm::test {
namespace {
using testing::AllOf;
using testing::HasSubstr;

class Cuda : public Typing {
 protected:
  void SetUp() override {
    Typing::SetUp();
    write("dam.yaml",
          "dreampm: 1\nname: dam\nspace: {max: [0.2, 0.12, 0.1], spacing: 0.02}\ntime: {fps: 50, frames: 2}\n"
          "materials: {water: {type: newtonian}}\n"
          "bodies: {dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.08, 0.08, 0.1]}}}}\n");
  }
  Typed with(const std::string& library, const std::string& line) const {
    return type(line, "export DREAMPM_CUDA='" + library + "'");
  }
};

TEST_F(Cuda, RunsByTheLibraryThatIsNamed) {
  const Typed device = with(STAND_IN, "info --device");
  EXPECT_EQ(device.code, 0) << device.out;
  EXPECT_EQ(device.out, "Stand-in, 1.0 GiB, sm_90, 0.5 GiB free\n");
  EXPECT_THAT(with(STAND_IN, "info").out, HasSubstr("Stand-in, 1.0 GiB"));
  for (const char* run : {"one", "two"})
    EXPECT_EQ(with(STAND_IN, std::string("run dam.yaml --backend cuda --out ") + run).code, 0);
  EXPECT_EQ(type("run dam.yaml --out three").code, 0);
  const auto one = record("one"), two = record("two"), by_cpu = record("three");
  EXPECT_EQ(one.at("backend"), "cuda");
  EXPECT_EQ(one.at("machine").at("isa"), "sm_90");
  EXPECT_EQ(one.at("frames"), two.at("frames"));
  EXPECT_EQ(one.at("frames").size(), by_cpu.at("frames").size());
  EXPECT_EQ(one.at("frames").back().at("particles"), by_cpu.at("frames").back().at("particles"));
}

TEST_F(Cuda, SaysWhyThereIsNone) {
  const Typed none = with("/nowhere/libdreampm_cuda.so", "info --device");
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.out, AllOf(HasSubstr("no CUDA"), HasSubstr("/nowhere"), HasSubstr("docs/guide/gpu.md")));
  const Typed refused = with("/nowhere/libdreampm_cuda.so", "run dam.yaml --backend cuda --out none");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("no CUDA"));
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
  EXPECT_THAT(with(STAND_IN_OF_ANOTHER, "info --device").out,
              AllOf(HasSubstr("belongs to another DreaMPM"), HasSubstr("0.0.1"), HasSubstr("make cuda")));
  EXPECT_THAT(with(STAND_IN_CHANGED, "info --device").out, HasSubstr("belongs to another DreaMPM"));
  EXPECT_THAT(with("libm.so.6", "info --device").out, HasSubstr("is no library of DreaMPM"));
  EXPECT_EQ(type("info dam.yaml --device").code, 2);
}

TEST_F(Cuda, NamesTheDeviceThatFails) {
  const auto chosen = [&](const char* number, const std::string& line) {
    return type(line, std::string("export DREAMPM_CUDA='") + STAND_IN + "' DREAMPM_STAND_IN=" + number);
  };
  const Typed full = chosen("1", "run dam.yaml --backend cuda --out full");
  EXPECT_EQ(full.code, 1);
  EXPECT_THAT(full.err, AllOf(HasSubstr("no room for"), HasSubstr("512.0 of 1024.0 MB are free")));
  const Typed failing = chosen("2", "run dam.yaml --backend cuda --out failing");
  EXPECT_EQ(failing.code, 1);
  EXPECT_THAT(failing.err, AllOf(HasSubstr("Stand-in"), HasSubstr("illegal memory access")));
  const Typed small = chosen("3", "run dam.yaml --backend cuda --out small");
  EXPECT_EQ(small.code, 1);
  EXPECT_THAT(small.err,
              AllOf(HasSubstr("80 particles need about"), HasSubstr("0.0 MB are free"), HasSubstr("spacing")));
  EXPECT_THAT(chosen("5", "info --device").out, HasSubstr("CUDA device 0: there is no device of that number"));
}

}  // namespace
}  // namespace dreampm::test
