#include "schema.h"

#include "verbs.h"

namespace dreampm::cli {

void add_schema(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false);
  CLI::App* verb = add_verb(app, "schema", "Print every key of a scene: for editors, or as a page",
                            "dreampm schema --json > dreampm-scene.schema.json");
  CLI::Option* flag =
      verb->add_flag("--json", *json, "print a JSON Schema, by which editors complete and check scenes");
  verb->add_flag("--markdown")->description("print the page docs/reference/scene.md (default)")->excludes(flag);
  verb->callback([json, &action] {
    action = [json] {
      fmt::print("{}", *json ? scene_json_schema() : scene_page());
      return 0;
    };
  });
}

}  // namespace dreampm::cli
