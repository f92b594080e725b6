// Scene files: what is read is written and read again.
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"
#include "one_input.h"

using namespace dreampm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_one(size, 2000, [&] {
    const scene::ParseResult first = scene::parse_scene_text(fuzz::text_of(data, size), fuzz::input_name);
    if (!first.ok()) return;
    const std::string text = scene::write_scene(first.scene);
    const scene::ParseResult second = scene::parse_scene_text(text, fuzz::input_name);
    if (!second.ok()) fuzz::fail("what is written of it is refused:\n" + text + second.text());
    if (scene::write_scene(second.scene) != text) fuzz::fail("it is written in two ways:\n" + text);
  });
  return 0;
}
