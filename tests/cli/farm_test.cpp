// A scene as a job of many tasks gives the film that `make` gives, whatever is stopped on the way.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>

#include "typed.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Three small frames of a scene with a mesh in it, which lies in a folder of its own.
const std::string cube_scene = R"(dreampm: 1
name: cube
space: {min: [0, 0, 0], max: [0.6, 0.4, 0.3], spacing: 0.03, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 3, cfl: 0.5}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {drop: {material: water, shape: {mesh: mine/cube.off, scale: 0.2, center: [0.15, 0.15, 0.15]}}}
output: {folder: out/cube}
render: {size: [32, 18], samples: 4, noise: 0.2, caustics: false, stage: {floor: none}}
)";

class Farm : public Typing {
 protected:
  void SetUp() override {
    Typing::SetUp();
    fs::create_directory(folder / "mine");
    write("mine/cube.off", cube);
    write("cube.yaml", cube_scene);
  }
  std::string film(const std::string& run) const { return read_file(folder / run / "cube.mp4"); }
  /// `make -j2` in the job's folder; MAKEFLAGS of a make around the tests are no part of it.
  Typed make_job(const std::string& job) const {
    return shell("env -u MAKEFLAGS -u MAKELEVEL make -C " + job + " -j2");
  }
};

TEST_F(Farm, AMakefileGivesTheFilmOfMakeAfterTheFolderMoved) {
  Typed t = type("farm cube.yaml --to make --chunk 2 --out job");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, "job/Makefile\n");
  EXPECT_THAT(t.err, HasSubstr("make -C job -j2"));
  ASSERT_EQ(type("make cube.yaml --out whole").code, 0);
  fs::remove_all(folder / "mine");
  fs::create_directory(folder / "far");
  fs::rename(folder / "job", folder / "far/job");
  t = make_job("far/job");
  ASSERT_EQ(t.code, 0) << t.out << t.err;
  EXPECT_TRUE(film("far/job") == film("whole")) << "the films differ";
  EXPECT_EQ(read_file(folder / "far/job/contact-sheet.png"), read_file(folder / "whole/contact-sheet.png"));
  const json run = record("far/job"), whole = record("whole");
  for (const char* stage : {"simulate", "surface", "render", "video"}) {
    EXPECT_EQ(run.at("stages").at(stage).at("frames"), 3) << stage;
    EXPECT_EQ(run.at("stages").at(stage).at("status"), "complete") << stage;
  }
  EXPECT_EQ(run.at("stages").at("surface").at("volumes"), whole.at("stages").at("surface").at("volumes"));
  EXPECT_FALSE(fs::exists(folder / "far/job/chunks"));
  EXPECT_EQ(read_file(folder / "far/job/render/frames.csv"), read_file(folder / "whole/render/frames.csv"));

  t = make_job("far/job");
  EXPECT_EQ(t.code, 0);
  EXPECT_THAT(t.err, HasSubstr("nothing to do: frames 1-2 of . is up to date"));
  EXPECT_THAT(t.err, Not(HasSubstr("render: frame")));
}

TEST_F(Farm, AModelReplacesTheOnlyMeshAndTravelsAlong) {
  std::string wedge = cube;  // one corner is cut off to the middle of an edge
  wedge.replace(wedge.find("1 1 1"), 5, "1 .5 1");
  write("mine/wedge.off", wedge);
  const std::string model = "--model mine/wedge.off ";
  ASSERT_EQ(type("farm cube.yaml " + model + "--to make --chunk 2 --out job").code, 0);
  ASSERT_EQ(type("make cube.yaml " + model + "--out whole").code, 0);
  std::vector<std::string> models;
  for (const auto& f : fs::recursive_directory_iterator(folder / "job/farm/models"))
    if (f.is_regular_file()) models.push_back(f.path().filename().string());
  EXPECT_EQ(models, std::vector<std::string>{"wedge.off"});
  fs::remove_all(folder / "mine");
  const Typed t = make_job("job");
  ASSERT_EQ(t.code, 0) << t.out << t.err;
  EXPECT_TRUE(film("job") == film("whole")) << "the films differ";
}

TEST_F(Farm, FoamIsMadeByTheTaskThatSimulates) {
  write("cube.yaml", std::string(cube_scene) + "foam: {amount: 100, scale: 0.05}\n");
  ASSERT_EQ(type("farm cube.yaml --to make --chunk 2 --out job").code, 0);
  ASSERT_EQ(type("make cube.yaml --out whole").code, 0);
  const Typed t = make_job("job");
  ASSERT_EQ(t.code, 0) << t.out << t.err;
  EXPECT_TRUE(film("job") == film("whole")) << "the films differ";
  const json run = record("job").at("stages").at("foam"), whole = record("whole").at("stages").at("foam");
  EXPECT_EQ(run.at("frames"), 3);
  EXPECT_EQ(run.at("foam"), whole.at("foam"));
  EXPECT_EQ(read_file(folder / "job/foam/foam_000003.ply"), read_file(folder / "whole/foam/foam_000003.ply"));
}

TEST_F(Farm, APartIsMadeAloneAndAgainOnlyWhereSomethingIsGone) {
  Typed t = type("make cube.yaml --only frames --frames 1-2");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("nothing is simulated there; dreampm make cube.yaml --only simulate"));
  ASSERT_EQ(type("make cube.yaml --only simulate").code, 0);
  EXPECT_FALSE(fs::exists(folder / "out/cube/surface"));
  ASSERT_EQ(type("make cube.yaml --only frames --frames 3").code, 0);
  EXPECT_TRUE(fs::exists(folder / "out/cube/render/render_000003.png"));
  EXPECT_FALSE(fs::exists(folder / "out/cube/render/render_000002.png"));
  t = type("make cube.yaml --only film");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("the surface of frame 1 is missing"));
  EXPECT_FALSE(fs::exists(folder / "out/cube/cube.mp4"));

  // What is gone of a chunk is made again, and no more.
  ASSERT_EQ(type("make cube.yaml --only frames --frames 1-2").code, 0);
  const auto kept = fs::last_write_time(folder / "out/cube/render/render_000001.png");
  fs::remove(folder / "out/cube/render/render_000002.png");
  t = type("make cube.yaml --only frames --frames 1-2");
  EXPECT_THAT(t.err, HasSubstr("render: render_000002.png is not there: 1 of 2 frames again"));
  EXPECT_EQ(fs::last_write_time(folder / "out/cube/render/render_000001.png"), kept);
  ASSERT_EQ(type("make cube.yaml --only film").code, 0);
  EXPECT_THAT(type("make cube.yaml").err, HasSubstr("nothing to do"));
  EXPECT_EQ(record("out/cube").at("status"), "complete");
}

TEST_F(Farm, AFrameThatWasTakenOutIsNotTakenForMade) {
  // Killed between taking a frame out and making it: the chunk's own notes say so, not the run's.
  ASSERT_EQ(type("run cube.yaml").code, 0);
  ASSERT_EQ(type("surface out/cube").code, 0);
  const std::string table = read_file(folder / "out/cube/surface/frames.csv");
  const std::size_t head = table.find('\n') + 1;
  fs::create_directories(folder / "out/cube/chunks/000001-000002");
  write("out/cube/chunks/000001-000002/surface.csv", table.substr(0, head) + "2,-,-\n");
  const Typed t = type("surface out/cube");
  EXPECT_THAT(t.err, HasSubstr("surface: going on, 2 of 3 frames are there"));
  EXPECT_EQ(read_file(folder / "out/cube/surface/frames.csv"), table);
}

TEST_F(Farm, TasksOfOtherScenesAndFramesAreRefused) {
  ASSERT_EQ(type("make cube.yaml --only simulate").code, 0);
  expect_refused("make cube.yaml --only frames --frames 3-4", "frame 4 is not simulated; it has 3 frames");
  expect_refused("make cube.yaml --only frames --frames 1-2 --set gravity=[0,-5,0]",
                 "is another scene than the one there (gravity: [0, -9.81, 0] -> [0, -5, 0])");
  expect_refused("make cube.yaml --only frames", "needs --frames A-B");
  expect_refused("make cube.yaml --frames 1-2", "--frames is for --only frames");
  expect_refused("make cube.yaml --only film --frames 1-2", "--frames is for --only frames");
  expect_refused("make cube.yaml --only pictures", "--only: pictures not in {simulate,frames,film}");
}

TEST_F(Farm, ChunksWorkBesideEachOtherAndNobodyBesideWhoHoldsTheFolder) {
  ASSERT_EQ(type("make cube.yaml --only simulate").code, 0);
  const int run = ::open((folder / "out/cube/lock").c_str(), O_RDWR);
  ASSERT_EQ(::flock(run, LOCK_SH | LOCK_NB), 0);  // as another chunk does
  EXPECT_EQ(type("make cube.yaml --only frames --frames 1-1").code, 0);
  const int chunk = ::open((folder / "out/cube/chunks/000001-000001/lock").c_str(), O_RDWR);
  ASSERT_EQ(::flock(chunk, LOCK_EX | LOCK_NB), 0);
  expect_refused("make cube.yaml --only frames --frames 1-1", "000001-000001: another process works in this folder");
  expect_refused("make cube.yaml --only film", "another process works in this folder");
  expect_refused("make cube.yaml", "another process works in this folder");
  ::close(chunk);
  ASSERT_EQ(::flock(run, LOCK_EX | LOCK_NB), 0);
  expect_refused("make cube.yaml --only frames --frames 1-1", "another process works in this folder");
  ::close(run);
}

TEST_F(Farm, AStoppedChunkGoesOn) {
  // The light on the floor takes more than a tenth of a second a picture.
  const std::string slow = "make cube.yaml --set render.stage.floor=tiles ";
  ASSERT_EQ(type(slow + "--only simulate").code, 0);
  Typed t = stop_at("out/cube/render/render_000001.png", slow + "--only frames --frames 1-3");
  EXPECT_EQ(t.code, 130);
  EXPECT_THAT(t.err, HasSubstr("type the same command again to go on"));
  t = type(slow + "--only frames --frames 1-3");
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.err, HasSubstr("going on, "));
  ASSERT_EQ(type(slow + "--only film").code, 0);
  EXPECT_THAT(type(slow).err, HasSubstr("nothing to do"));
}

TEST_F(Farm, JobsOfOtherProgramsHaveTheTasksInTheirOrder) {
  ASSERT_EQ(type("farm cube.yaml --to openjd --chunk 2").code, 0);
  const std::string job = read_file(folder / "out/cube/template.yaml");
  for (const char* line :
       {"specificationVersion: jobtemplate-2023-09\n", "extensions: [TASK_CHUNKING]\n", "- dependsOn: Simulate\n",
        "- dependsOn: Frames\n", "range: \"1-3\"\n", "chunks: {defaultTaskCount: 2, rangeConstraint: CONTIGUOUS}"})
    EXPECT_THAT(job, HasSubstr(line));
  ASSERT_EQ(type("farm cube.yaml --to slurm --chunk 2 --isa sse4 --threads 3").code, 0);
  const std::string script = read_file(folder / "out/cube/slurm.sh");
  EXPECT_THAT(script, HasSubstr("--only simulate --out . --isa sse4 --threads 3'"));
  EXPECT_THAT(script, HasSubstr("--frames $first-$last --out . --threads 3' --array=0-1)\n"));
  EXPECT_EQ(shell("bash -n out/cube/slurm.sh").code, 0);
}

/// A cluster of one machine, at once: sbatch that runs what it is given.
TEST_F(Farm, TheScriptOfSlurmSubmitsWhatGivesTheFilm) {
  fs::create_directory(folder / "bin");
  write("bin/sbatch", R"sh(#!/bin/bash
# Runs the line at once, for an array once a task; prints a number, and notes the options.
array=0-0
for word; do
  case $word in --wrap=*) line=${word#--wrap=};; --array=*) array=${word#--array=};; esac
done
echo "$@" >>sbatch.log
for task in $(seq ${array%-*} ${array#*-}); do
  SLURM_ARRAY_TASK_ID=$task sh -c "$line" >&2 || exit 1
done
wc -l <sbatch.log
)sh");
  ASSERT_EQ(type("farm cube.yaml --to slurm --chunk 1 --set time.frames=2").code, 0);
  ASSERT_EQ(type("make cube.yaml --out whole --set time.frames=2").code, 0);
  const Typed t = shell("chmod +x bin/sbatch && PATH=$PWD/bin:$PATH bash out/cube/slurm.sh --partition=film");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, "submitted; the last job is 3\n");
  EXPECT_TRUE(film("out/cube") == film("whole")) << "the films differ";
  const std::string log = read_file(folder / "out/cube/sbatch.log");
  EXPECT_THAT(log, HasSubstr("--dependency=afterok:1 --partition=film --array=0-1"));
  EXPECT_THAT(log, HasSubstr("--dependency=afterok:2 --partition=film --wrap"));
}

TEST_F(Farm, BadInputIsRefusedAndWritesNothing) {
  expect_refused("farm cube.yaml --to opnjd", "--to");
  expect_refused("farm cube.yaml", "--to is required");
  expect_refused("farm cube.yaml --to make --chunk 0", "0 is no whole number from 1");
  expect_refused("farm none.yaml --to make", "none.yaml: no such scene file");
  expect_refused("farm cube.yaml --to make --set space.spcing=1", "did you mean 'spacing'?");
  write("bad.yaml", cube_scene + "materals: {}\n");
  expect_refused("farm bad.yaml --to make", "bad.yaml:9:1: error: unknown key 'materals'; did you mean 'materials'?");
  expect_refused("farm cube.yaml --to make --model none.off", "none.off");
  write("box.yaml", cube_scene.substr(0, cube_scene.find("mesh:")) + "box: {size: [0.1, 0.1, 0.1]}, " +
                        cube_scene.substr(cube_scene.find("center:")));
  expect_refused("farm box.yaml --to make --model mine/cube.off",
                 "--model: the scene has 0 bodies with a mesh; it replaces the mesh of exactly one");
  fs::remove(folder / "mine/cube.off");
  EXPECT_EQ(type("farm cube.yaml --to make").code, 2);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

}  // namespace
}  // namespace dreampm::test
