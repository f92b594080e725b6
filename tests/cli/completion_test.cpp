// Completions that bash offers while a line is typed.
#include <gmock/gmock.h>

#include "typed.h"

namespace dreampm::test {
namespace {
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Completion : public Typing {
 protected:
  /// Returns the completions that bash offers for the last of these words.
  std::string offered(const std::string& words) const {
    write("ask.sh", "source ./script\nCOMP_WORDS=(" + std::string(DM_COMMAND) + " " + words +
                        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_dreampm\necho \"${COMPREPLY[@]}\"\n");
    const Typed t = shell("'" DM_COMMAND "' completion bash > script && bash ask.sh");
    EXPECT_EQ(t.err, "");
    return t.out;
  }
};

TEST_F(Completion, KnowsTheVariantsOfTheSceneThatTheLineNames) {
  write("dam.yaml", tiny_dam + "variants:\n  fine: {seed: 2}\n  coarse: {seed: 3}\n");
  EXPECT_EQ(offered("make dam.yaml --variant \"\""), "fine coarse\n");
  EXPECT_EQ(offered("run dam.yaml --variant f"), "fine\n");
  EXPECT_EQ(offered("run gone.yaml --variant \"\""), "\n");
  EXPECT_EQ(type("completion --variants dam.yaml").out, "fine\ncoarse\n");
  EXPECT_EQ(type("completion").code, 2);
}

TEST_F(Completion, KnowsTheCasesOfValidation) {
  EXPECT_EQ(offered("validate still-c"), "still-column\n");
  EXPECT_THAT(offered("validate --quick \"\""), AllOf(HasSubstr("dam-break"), HasSubstr("sloshing")));
  EXPECT_THAT(type("validate no-such-case").err, HasSubstr("no-such-case")) << "the parser has its own message";
  for (const char* shell : {"zsh", "fish"})
    EXPECT_THAT(type(std::string("completion ") + shell).out,
                AllOf(HasSubstr("still-column"), HasSubstr("--variants")));
}

}  // namespace
}  // namespace dreampm::test
