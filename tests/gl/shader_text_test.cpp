#include "dreampm/gl/shader_text.h"

#include <gmock/gmock.h>

#include "thrown.h"

namespace dreampm::gl {
namespace {
using testing::HasSubstr;

TEST(ShaderText, IncludesAreTakenOnceAndLinesCountWithinTheirFile) {
  const ShaderSource source = assemble_shader("skin.frag");
  EXPECT_EQ(source.files.at(0), "skin.frag");
  EXPECT_EQ(source.files.at(1), "frame");
  EXPECT_THAT(source.text, testing::StartsWith("#version 330 core\n#line 1 0\n"));
  EXPECT_THAT(source.text, testing::Not(HasSubstr("#include")));
  const std::size_t once = source.text.find("uniform Frame");
  EXPECT_EQ(source.text.find("uniform Frame", once + 1), std::string::npos);
}

TEST(ShaderText, AnUnknownShaderIsNamed) {
  EXPECT_THAT(dreampm::test::message_of<RunError>([] { assemble_shader("glitter.frag"); }),
              HasSubstr("glitter.frag.glsl"));
}

// Mesa writes 1:12(3), others 1(12).
TEST(ShaderText, MessagesNameTheFileAndTheLine) {
  const std::vector<std::string_view> files{"water.frag", "frame"};
  EXPECT_EQ(with_file_names("1:12(3): error: no\n0(7) : error C1\nplain", files),
            "frame.glsl:12(3): error: no\nwater.frag.glsl(7) : error C1\nplain\n");
}

}  // namespace
}  // namespace dreampm::gl
