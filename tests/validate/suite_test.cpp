// Cases side by side.
#include "validate/suite.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/base/parallel.h"

namespace dreampm::validate {
namespace {

namespace fs = std::filesystem;

fs::path folder() {
  const fs::path f = fs::path(testing::TempDir()) / "dreampm_validate_suite";
  make_folder(f);
  return f;
}

std::atomic<int> begun{0}, short_began{0}, long_began{0}, most_threads{0};

void look(Trial& t) {
  std::atomic<int> inside{0};
  parallel_for(64, 1, [&](std::size_t) {
    const int now = ++inside;
    int seen = most_threads;
    while (now > seen && !most_threads.compare_exchange_weak(seen, now)) {
    }
    --inside;
  });
  t.at_most("nothing", 0, 1);
  t.control("something", "nothing", 2);
}
void short_one(Trial& t) { short_began = ++begun, look(t); }
void long_one(Trial& t) { long_began = ++begun, look(t); }

const Case quick_a{"a", "short", "none", true, short_one, 1}, slow_b{"b", "long", "none", true, long_one, 9};
const Case quick_c{"c", "short", "none", true, look, 1};
const Case wrong{"wrong", "asks for what is not there", "none", true, [](Trial&) { fail_input("no such file"); }, 1};

TEST(Suite, BeginsWithTheLongestAndTellsInTheOrderAsked) {
  const ThreadLimit threads(2);
  begun = 0, most_threads = 0;
  const Case* cases[] = {&quick_a, &slow_b, &quick_c};
  std::string reported;
  const auto results = run_cases(cases, Options{}, folder(), [&](const Result& r) { reported += r.which->name; });
  EXPECT_EQ(reported, "abc");
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[1].which, &slow_b);
  EXPECT_TRUE(succeeded(results));
  EXPECT_EQ(most_threads, 1) << "a case beside others has one thread";
}

TEST(Suite, OnOneThreadTheLongestComesFirst) {
  const ThreadLimit threads(1);
  begun = 0;
  const Case* cases[] = {&quick_a, &slow_b};
  run_cases(cases, Options{}, folder(), [](const Result&) {});
  EXPECT_EQ(long_began, 1);
  EXPECT_EQ(short_began, 2);
}

TEST(Suite, AtTheFullLevelTheLongestOfThatLevelComesFirst) {
  const ThreadLimit threads(1);
  begun = 0;
  const Case longest_in_full{"c", "short", "none", true, short_one, 1, 90};
  const Case* cases[] = {&slow_b, &longest_in_full};
  run_cases(cases, Options{.level = Level::full}, folder(), [](const Result&) {});
  EXPECT_EQ(short_began, 1);
  EXPECT_EQ(long_began, 2) << "a case without seconds of its own there takes as long as at the quick level";
}

TEST(Suite, ACaseWithAWrongInputFailsAndTheOthersAreTold) {
  const ThreadLimit threads(2);
  const Case* cases[] = {&quick_a, &wrong, &quick_c};
  const auto results = run_cases(cases, Options{}, folder(), [](const Result&) {});
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[1].error, "no such file");
  EXPECT_FALSE(succeeded(results));
  EXPECT_TRUE(results[0].passed() && results[2].passed());
}

TEST(Suite, WhatWasDoneBeforeASignalIsToldAndReturned) {
  const ThreadLimit threads(1);
  const Case stopped{"stopped", "a signal comes", "none", true, [](Trial&) { throw Interrupted("stop"); }, 5};
  const Case* cases[] = {&stopped, &quick_a, &slow_b, &quick_c};  // in the order b, stopped, a, c
  std::string reported;
  const auto results = run_cases(cases, Options{}, folder(), [&](const Result& r) { reported += r.which->name; });
  EXPECT_EQ(reported, "b");
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].which, &slow_b);
}

}  // namespace
}  // namespace dreampm::validate
