#include "dreampm/io/run_record.h"

#include <nlohmann/json.hpp>

#include "dreampm/version.h"
#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

RunRecord sample() {
  RunRecord r = RunRecord::for_this_build();
  r.scene = "scenes/jelly.yaml";
  r.variant = "preview";
  r.scene_hash = "9f00000000000000";
  r.status = "failed";
  r.cause = "a \"quoted\" reason";
  r.machine = this_machine("avx2", 2);
  r.particles = 131072;
  r.spacing = 0.006;
  r.dx = 0.012;
  r.backend = "cpu";
  r.frames = {{1, 0.0, 0, "0123456789abcdef", 131072, 0}, {2, 1.0 / 24, 41, "fedcba9876543210", 131070, 2}};
  r.stages["simulate"] = {41.2, 120, 2600000000ull, 310000000ull, "77", {}};
  r.stages["surface"].volumes = {{1, "water", 0.028, 0.0281, {}}, {2, "water", 0.028, 0.0275, 0.027}};
  r.bodies = {{"dragon", 0, 131000}, {"drop", 131000, 72}};
  r.warnings = {"bodies a and b overlap by 0.001 m^3"};
  return r;
}

TEST(RunRecord, ComesBackFromItsFile) {
  const fs::path file = test::fresh_folder() / "run.json";
  const RunRecord a = sample();
  a.save(file);
  const RunRecord b = RunRecord::load(file);
  EXPECT_EQ(b.to_json(), a.to_json());
  EXPECT_EQ(b.frames[1].time, 1.0 / 24);
  EXPECT_EQ(b.frames[1].left, 2u);
  EXPECT_EQ(b.spacing, 0.006);
  EXPECT_EQ(b.variant, "preview");
  EXPECT_EQ(b.stages.at("simulate").particle_steps, 2600000000ull);
  EXPECT_EQ(b.stages.at("simulate").seconds, 41.2);
  EXPECT_FALSE(b.stages.at("render").seconds.has_value());
  EXPECT_EQ(b.warnings, a.warnings);
}

TEST(RunRecord, HasTheFormatsKeys) {
  RunRecord r = sample();
  r.variant.reset();
  r.cause.reset();
  const json j = json::parse(r.to_json());
  EXPECT_EQ(j["format"], 1);
  EXPECT_EQ(j["dreampm"], version);
  EXPECT_EQ(j["commit"], commit);
  EXPECT_EQ(j["scene"], "scenes/jelly.yaml");
  EXPECT_TRUE(j["variant"].is_null());
  EXPECT_TRUE(j["cause"].is_null());
  for (const char* key : {"cpu", "cores", "threads", "isa", "memory_bytes"}) EXPECT_TRUE(j["machine"].contains(key));
  for (const char* key : {"frame", "time", "substeps", "state_hash", "particles", "left"})
    EXPECT_TRUE(j["frames"][0].contains(key)) << key;
  for (const char* key : {"seconds", "frames", "particle_steps", "peak_memory_bytes"})
    EXPECT_TRUE(j["stages"]["simulate"].contains(key)) << key;
  for (const char* stage : {"render", "video"}) EXPECT_EQ(j["stages"][stage], json::object());
  EXPECT_EQ(j["stages"]["surface"]["volumes"][0],
            (json{{"frame", 1}, {"material", "water"}, {"particles", 0.028}, {"mesh", 0.0281}}));
  EXPECT_EQ(j["stages"]["surface"]["volumes"][1],
            (json{{"frame", 2}, {"material", "water"}, {"particles", 0.028}, {"mesh", 0.0275}, {"taken", 0.027}}));
  EXPECT_EQ(j["bodies"][1], (json{{"name", "drop"}, {"first_id", 131000}, {"count", 72}}));
  for (const char* key : {"scene_hash", "status", "particles", "spacing", "dx", "backend", "warnings"})
    EXPECT_TRUE(j.contains(key)) << key;
}

TEST(RunRecord, SaysWhichStageFailed) {
  RunRecord r = RunRecord::for_this_build();
  r.end_stage("simulate", "complete");
  EXPECT_EQ(r.status, "complete");
  r.end_stage("render", "failed", "no light");
  r.end_stage("surface", "failed", "no water");
  EXPECT_EQ(r.status, "failed");
  EXPECT_EQ(r.failed_stage, "surface") << "the first in the order that they run";
  EXPECT_EQ(r.cause, "no water");
  r = RunRecord::from_json(r.to_json(), "run.json");
  EXPECT_EQ(r.stages.at("render").cause, "no light");
  r.end_stage("surface", "complete");
  EXPECT_EQ(r.failed_stage, "render");
  r.end_stage("render", std::nullopt);
  EXPECT_EQ(r.status, "complete");
  EXPECT_FALSE(r.cause);
  EXPECT_FALSE(json::parse(r.to_json()).contains("stage"));
}

TEST(RunRecord, UnknownKeysAreSkipped) {
  json j = json::parse(sample().to_json());
  j["added_later"] = {1, 2, 3};
  j["frames"][0]["more"] = "x";
  EXPECT_EQ(RunRecord::from_json(j.dump(), "run.json").to_json(), sample().to_json());
}

TEST(RunRecord, WrongFilesAreNamedWithTheirKey) {
  const std::string good = sample().to_json();
  const auto error = [&](const auto& change) {
    json j = json::parse(good);
    change(j);
    return message_of<InputError>([&] { RunRecord::from_json(j.dump(), "d/run.json"); });
  };
  EXPECT_THAT(error([](json& j) { j["format"] = 2; }), HasSubstr("d/run.json: format 2; this dreampm reads format 1"));
  EXPECT_THAT(error([](json& j) { j.erase("scene_hash"); }), HasSubstr("scene_hash is missing"));
  EXPECT_THAT(error([](json& j) { j["frames"][1]["time"] = "soon"; }),
              HasSubstr("frames[1].time must be a number, is \"soon\""));
  EXPECT_THAT(error([](json& j) { j["frames"][0]["substeps"] = -4; }),
              HasSubstr("frames[0].substeps must be a whole number, not negative, is -4"));
  EXPECT_THAT(error([](json& j) { j["machine"]["cores"] = 1e10; }), HasSubstr("machine.cores must be a whole number"));
  EXPECT_THAT(error([](json& j) { j["machine"]["cores"] = 4000000000u; }), HasSubstr("machine.cores must be"));
  EXPECT_THAT(error([](json& j) { j["status"] = "fine"; }),
              HasSubstr("status must be complete, interrupted or failed"));
  EXPECT_THAT(error([](json& j) { j["stages"]["render"] = 3; }), HasSubstr("stages.render"));
  EXPECT_THAT(error([](json& j) { j["frames"] = 3; }), HasSubstr("frames must be a list, is 3"));
  EXPECT_THAT(error([](json& j) { j = json::array({1}); }), HasSubstr("the file must be an object"));
  for (const std::size_t size : {std::size_t(0), std::size_t(1), good.size() / 2, good.size() - 3})
    EXPECT_THAT(message_of<InputError>([&] { RunRecord::from_json(good.substr(0, size), "d/run.json"); }),
                AllOf(HasSubstr("d/run.json"), HasSubstr("not JSON, or truncated")));
  EXPECT_THAT(message_of<InputError>([&] { RunRecord::from_json("{\"format\": 1e999}", "d/run.json"); }),
              HasSubstr("d/run.json: not JSON that can be read"));
  // Nothing may call itself for each list in a list.
  const std::string deep = std::string(300000, '[') + std::string(300000, ']');
  EXPECT_THAT(message_of<InputError>([&] { RunRecord::from_json(deep, "d/run.json"); }),
              HasSubstr("the file must be an object, is a list"));
  EXPECT_THAT(message_of<InputError>([&] { RunRecord::load(test::fresh_folder() / "run.json"); }),
              HasSubstr("run.json: cannot be read"));
}

TEST(RunRecord, AFullDiskLeavesTheOldFile) {
  const fs::path folder = test::fresh_folder();
  RunRecord r = sample();
  r.save(folder / "run.json");
  const std::string before = read_file(folder / "run.json");
  r.frames.resize(100, r.frames.back());
  const test::FileSizeLimit small(2000);
  EXPECT_THAT(message_of<RunError>([&] { r.save(folder / "run.json"); }), HasSubstr("File too large"));
  EXPECT_EQ(read_file(folder / "run.json"), before);
  EXPECT_EQ(test::files_in(folder), 1u);
}

TEST(RunRecord, BytesThatAreNoTextDoNotStopIt) {
  RunRecord r = sample();
  r.scene =
      "sc\xff"
      "ene.yaml";
  EXPECT_THAT(RunRecord::from_json(r.to_json(), "run.json").scene, HasSubstr("ene.yaml"));
}

TEST(Machine, TellsOfThisOne) {
  const MachineRecord m = this_machine("scalar", 3);
  EXPECT_FALSE(m.cpu.empty());
  EXPECT_GE(m.cores, 1);
  EXPECT_EQ(m.threads, 3);
  EXPECT_EQ(m.isa, "scalar");
  EXPECT_GT(m.memory_bytes, 64ull << 20);
  EXPECT_GT(available_memory_bytes(), 0u);
  EXPECT_LE(available_memory_bytes(), m.memory_bytes);
}

TEST(Machine, PeakMemorySeesALargeBlock) {
  const std::uint64_t before = peak_memory_bytes();
  {
    // Through a volatile pointer, or a compiler may see that the block is never needed.
    std::vector<char> block(std::size_t(200) << 20, 1);
    volatile char* touched = block.data();
    for (std::size_t i = 0; i < block.size(); i += 4096) touched[i] = 2;
    EXPECT_EQ(touched[0], 2);
  }
  EXPECT_GT(before, 0u);
  EXPECT_GE(peak_memory_bytes(), std::uint64_t(200) << 20);
}

}  // namespace
}  // namespace dreampm
