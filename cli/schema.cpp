#include "schema.h"

#include "verbs.h"

namespace dreampm::cli {

void add_schema(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false), ledger = std::make_shared<bool>(false);
  CLI::App* verb = add_verb(app, "schema", "Print every key of a scene: for editors, or as a page",
                            "dreampm schema --json > dreampm-scene.schema.json");
  CLI::Option* flag =
      verb->add_flag("--json", *json, "print a JSON Schema, by which editors complete and check scenes");
  verb->add_flag("--markdown")->description("print the page docs/reference/scene.md (default)")->excludes(flag);
  verb->add_flag("--ledger", *ledger, "print the columns of ledger.csv, as docs/reference/ledger.md has them")
      ->excludes("--json")
      ->excludes("--markdown");
  verb->callback([json, ledger, &action] {
    action = [json, ledger] {
      fmt::print("{}", *json ? scene_json_schema() : *ledger ? ledger_page() : scene_page());
      return 0;
    };
  });
}

}  // namespace dreampm::cli
