// `dreampm schema` and `dreampm help`: the pages that they make, and the schema for editors.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "typed.h"

namespace dreampm::test {
namespace {
using nlohmann::json;
using testing::HasSubstr;

class SchemaVerb : public Typing {
 protected:
  std::string page(const std::string& name) const {
    return read_file(std::filesystem::path(DM_SOURCE_DIR) / "docs/reference" / name);
  }
};

TEST_F(SchemaVerb, ThePageOfTheSceneIsWhatTheCommandPrints) {
  const Typed t = type("schema --markdown");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, page("scene.md")) << "run: dreampm schema --markdown > docs/reference/scene.md";
  EXPECT_EQ(type("schema").out, t.out);
  EXPECT_EQ(type("schema --markdown --json").code, 2);
}

TEST_F(SchemaVerb, TheColumnsOfTheLedgersPageAreWhatTheCommandPrints) {
  const Typed t = type("schema --ledger");
  ASSERT_EQ(t.code, 0) << t.err;
  const std::string text = page("ledger.md");
  const std::size_t from = text.find("## Columns\n"), to = text.find("\n## ", from + 1);
  ASSERT_NE(to, std::string::npos);
  EXPECT_EQ(t.out, text.substr(from, to - from)) << "print it anew: dreampm schema --ledger";
  EXPECT_EQ(type("schema --ledger --json").code, 2);
}

TEST_F(SchemaVerb, EveryKeyTakesSomethingAndMeansSomething) {
  std::istringstream lines(type("schema").out);
  const std::regex row("\\| `([a-z_]+)` \\| (.*) \\| (.*) \\| (.*) \\|");
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (!std::regex_match(line, m, row)) continue;
    ++keys;
    EXPECT_FALSE(m[2].str().empty()) << line;
    EXPECT_THAT(m[4].str(), testing::EndsWith(".")) << line;
  }
  EXPECT_GT(keys, 200);
}

/// Every reference within the schema, and every map of keys that lets unknown ones pass.
void walk(const json& node, const json& root, int& references, int& open) {
  if (!node.is_structured()) return;
  if (node.is_object() && node.contains("$ref")) {
    const std::string path = node["$ref"].get<std::string>().substr(1);
    EXPECT_TRUE(root.contains(json::json_pointer(path))) << path;
    ++references;
  }
  if (node.is_object() && node.value("type", json()) == "object" && node.contains("properties") &&
      node["properties"].is_object() && node.value("additionalProperties", json()) != false)
    ++open;
  for (const auto& item : node.items()) walk(item.value(), root, references, open);
}

TEST_F(SchemaVerb, TheSchemaForEditorsRefusesUnknownKeysEverywhere) {
  const Typed t = type("schema --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json schema = json::parse(t.out);
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_THAT(schema["required"], testing::UnorderedElementsAre("dreampm", "name", "space", "materials"));
  int references = 0, open = 0;
  walk(schema, schema, references, open);
  EXPECT_GT(references, 20);
  EXPECT_EQ(open, 0);
  const json& spacing = schema["properties"]["space"]["properties"]["spacing"];
  EXPECT_EQ(spacing["exclusiveMinimum"], 0);
  EXPECT_THAT(spacing["description"].get<std::string>(), HasSubstr("[m]"));
  EXPECT_EQ(schema["properties"]["gravity"]["default"], json({0, -9.81, 0}));
  // A variant changes some keys, so none is required in it.
  const json& variant = schema["properties"]["variants"]["additionalProperties"];
  EXPECT_FALSE(variant.contains("required"));
  EXPECT_FALSE(variant["properties"].contains("variants"));
  EXPECT_TRUE(variant["properties"]["space"]["properties"].contains("spacing"));
}

TEST_F(SchemaVerb, HelpIsThatOfTheVerb) {
  EXPECT_EQ(type("help run").out, type("run --help").out);
  EXPECT_EQ(type("help bench step").out, type("bench step --help").out);
  EXPECT_EQ(type("help").out, type("--help").out);
  const Typed wrong = type("help rnu");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'run'?"));
  EXPECT_EQ(type("help run fast").err, "error: no verb 'fast': run has no verbs of its own\n");
}

TEST_F(SchemaVerb, BeforeAVerbAWrongOptionIsNamed) {
  EXPECT_EQ(type("--vrsion").err, "error: dreampm has no option '--vrsion' before a verb; did you mean '--version'?\n");
  EXPECT_THAT(type("--out x make dam.yaml").err, HasSubstr("no option '--out' before a verb; known: "));
  EXPECT_THAT(type("-x").err, testing::StartsWith("error: dreampm has no option '-x' before a verb"));
  EXPECT_EQ(type("-x").code, 2);
  EXPECT_EQ(type("version").err, "error: no verb 'version': dreampm --version prints it\n");
  EXPECT_EQ(type("version").code, 2);
  EXPECT_THAT(type("").err, HasSubstr("error: no verb; dreampm --help lists them"));
  EXPECT_EQ(type("--version").code, 0);
  EXPECT_EQ(type("-h").code, 0);
}

#ifdef DM_APP
TEST_F(SchemaVerb, ThePageOfTheCommandLineIsWhatTheCommandPrints) {
  const Typed t = type("help --markdown");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_EQ(t.out, page("command-line.md")) << "run: dreampm help --markdown > docs/reference/command-line.md";
}
#endif

}  // namespace
}  // namespace dreampm::test
