// The texts of --set, one a line, over a scene that has a bit of everything.
#include <algorithm>

#include "dreampm/scene/parse.h"
#include "one_input.h"

using namespace dreampm;
namespace {

constexpr const char* base = R"(dreampm: 1
name: base
space: {min: [0, 0, 0], max: [1, 1, 1], spacing: 0.02, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 25}
materials:
  water: {type: newtonian, preset: water}
  jelly: {type: elastic, preset: jelly}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.3, 0.3, 0.4]}}}
  cube: {material: jelly, shape: {box: {size: [0.1, 0.1, 0.1]}, center: [0.5, 0.5, 0.5]}}
colliders:
  ball: {shape: {sphere: {radius: 0.1}, center: [0.5, 0.2, 0.5]}, type: separate, friction: 0.2}
emitters:
  tap: {material: water, shape: {disk: {center: [0.5, 0.9, 0.5], normal: [0, -1, 0], radius: 0.05}}, speed: 1}
variants:
  fine: {space: {spacing: 0.01}}
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_one(size, 2000, [&] {
    scene::ParseOptions options;
    const std::string_view text = fuzz::text_of(data, size);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      options.overrides.emplace_back(text.substr(at, end - at));
      at = end + 1;
    }
    scene::parse_scene_text(base, fuzz::input_name, options);
  });
  return 0;
}
