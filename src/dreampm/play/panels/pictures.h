// Small pictures of the stories and of the kinds of matter, as textures for the panels.
#pragma once
#include <map>
#include <string>
#include <string_view>

namespace dreampm::play {

/// Needs a current context of OpenGL from its birth to its end.
class Pictures {
 public:
  /// Those that are built in: scenes/play/pictures.
  Pictures();
  ~Pictures();
  Pictures(const Pictures&) = delete;
  Pictures& operator=(const Pictures&) = delete;

  struct Picture {
    unsigned texture;
    int width, height;
  };
  /// By the name of its file, without the ending; null where there is none.
  const Picture* find(std::string_view name) const;

 private:
  std::map<std::string, Picture, std::less<>> all_;
};

}  // namespace dreampm::play
