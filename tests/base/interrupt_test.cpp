// Signals are raised in a child process, so that the test program itself lives on.
#include "dreampm/base/interrupt.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace dreampm;

namespace {

/// How a child that runs `work` ended, as waitpid reports it.
template <class Work>
int status_of(Work work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return status;
}

class Interrupt : public testing::TestWithParam<int> {};

TEST_P(Interrupt, TheFirstSignalSetsTheFlag) {
  const int status = status_of([] {
    catch_interrupts();
    if (interrupted()) return 3;
    raise(GetParam());
    return interrupted() ? 0 : 4;
  });
  ASSERT_TRUE(WIFEXITED(status)) << "the signal ended the process: nothing could be saved";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_P(Interrupt, TheSecondEndsTheProcess) {
  const int status = status_of([] {
    catch_interrupts();
    raise(GetParam());
    raise(GetParam());
    return 0;
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM));

}  // namespace
