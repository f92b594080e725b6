// What jobs say of their tasks.
#include "dreampm/farm/job.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "dreampm/farm/formats.h"
#include "thrown.h"

namespace dreampm::farm {
namespace {
using testing::HasSubstr;

const Format& format(const std::string& name) {
  for (const Format& f : formats())
    if (f.name == name) return f;
  throw std::out_of_range(name);
}

Job job_of(std::vector<JobRun> runs, int chunk) {
  Job job;
  job.name = "dam";
  job.runs = std::move(runs);
  job.chunk = chunk;
  job.is_wedge = job.runs.size() > 1;
  return job;
}

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(Jobs, EveryFrameIsInOneChunk) {
  const std::string text = format("make").text(job_of({{"dam", "farm/scene.yaml", ".", 25}}, 10));
  for (const char* range : {" --frames 1-10 ", " --frames 11-20 ", " --frames 21-25 "})
    EXPECT_THAT(text, HasSubstr(range));
  EXPECT_EQ(count(text, "--only frames"), 3);
  EXPECT_THAT(text, HasSubstr("film-1: frames-1-1 frames-1-2 frames-1-3\n"));
}

TEST(Jobs, MoreChunksThanAnArrayOfSlurmHoldsAreSeveralArrays) {
  const std::string text = format("slurm").text(job_of({{"dam", "farm/scene.yaml", ".", 4001}}, 2));
  EXPECT_EQ(count(text, "--array=0-999"), 2);
  EXPECT_EQ(count(text, "--array=0-0"), 1);
  EXPECT_THAT(text, HasSubstr("first=$((2001 + SLURM_ARRAY_TASK_ID * 2))"));
  EXPECT_THAT(text, HasSubstr("first=$((4001 + SLURM_ARRAY_TASK_ID * 2))"));
}

TEST(Jobs, RunsOfOneLengthAreOneStepOfATemplate) {
  const JobRun a{"a=1", "farm/a=1.yaml", "a=1", 8}, b{"a=2", "farm/a=2.yaml", "a=2", 8},
      c{"a=3", "farm/a=3.yaml", "a=3", 9};
  const std::string same = format("openjd").text(job_of({a, b}, 10)),
                    other = format("openjd").text(job_of({a, b, c}, 10));
  EXPECT_EQ(count(same, "type: CHUNK[INT]"), 1);
  EXPECT_THAT(same, HasSubstr("range: [\"a=1\", \"a=2\"]"));
  EXPECT_EQ(count(other, "type: CHUNK[INT]"), 2);
  EXPECT_THAT(other, HasSubstr("- dependsOn: FilmOf8\n      - dependsOn: FilmOf9\n"));
  std::vector<JobRun> many(1025, a);
  EXPECT_THAT(test::refusal([&] { format("openjd").text(job_of(many, 10)); }),
              HasSubstr("a template takes at most 1024"));
}

TEST(Jobs, WordsReachTheProgramAsTheyAre) {
  Job job = job_of({{"dam", "farm/scene.yaml", ".", 2}}, 2);
  job.program = "/opt/it's $HOME/dreampm";
  EXPECT_EQ(shell_word(job.program), R"('/opt/it'\''s $HOME/dreampm')");
  EXPECT_THAT(format("openjd").text(job), HasSubstr(R"(default: "/opt/it's $HOME/dreampm")"));
  EXPECT_THAT(format("make").text(job), HasSubstr(R"(DREAMPM ?= '/opt/it'\''s $$HOME/dreampm')"));
  EXPECT_THAT(format("slurm").text(job), HasSubstr(R"(export DREAMPM=${DREAMPM:-'/opt/it'\''s $HOME/dreampm'})"));
}

}  // namespace
}  // namespace dreampm::farm
