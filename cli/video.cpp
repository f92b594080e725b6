#include "verbs.h"

namespace dreampm::cli {

void add_video(CLI::App& app, Action& action) {
  auto folder = std::make_shared<std::string>();
  CLI::App* verb = add_verb(app, "video", "Make a film and a contact sheet from the pictures of a run",
                            "dreampm video out/dragon-splatting-preview");
  verb->add_option("DIR", *folder, "a run's folder with its pictures")->required();
  verb->callback([folder, &action] {
    action = [folder] {
      RunFolder run = open_run(*folder, Access::write);
      if (video_stage(run).made == 0) info("nothing to do: {} is up to date", video_file(run).string());
      fmt::print("{}\n", video_file(run).string());
      return 0;
    };
  });
}

}  // namespace dreampm::cli
