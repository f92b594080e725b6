// Output to a terminal, by util-linux's `script`.
#include <gmock/gmock.h>

#include "typed.h"

namespace dreampm::test {
namespace {
using testing::HasSubstr;
using testing::Not;

TEST_F(TypingAtADam, LinesHaveColorsOnATerminalUnlessNoColorIsSet) {
  const auto shown = [&](const std::string& before) {
    write("ask.sh", before + " script -qc \"'" DM_COMMAND "' run dam.yaml --frames 1 --overwrite\" /dev/null\n");
    const Typed t = shell("unset NO_COLOR; sh ask.sh");
    EXPECT_EQ(t.code, 0) << t.err;
    EXPECT_THAT(t.out, HasSubstr("bulk modulus"));
    return t.out;
  };
  EXPECT_THAT(shown(""), HasSubstr("\x1b[32m"));
  EXPECT_THAT(shown("NO_COLOR="), HasSubstr("\x1b[32m")) << "empty is not set";
  EXPECT_THAT(shown("NO_COLOR=1"), Not(HasSubstr("\x1b[32m")));
}

}  // namespace
}  // namespace dreampm::test
