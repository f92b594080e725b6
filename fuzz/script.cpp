// Scripts of the playground, as --record writes them and --replay plays them: the lines, not what
// they do.
#include <algorithm>

#include "dreampm/play/model/action.h"
#include "one_input.h"

using namespace dreampm;
using play::Action;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const auto one = [&](const auto& what) { fuzz::read_one(size, 200, what, ""); };
    Action action;
    one([&] { action = Action::parse(text.substr(at, end - at)); });
    if (!action.verb.empty())
      one([&] {
        if (Action::parse(action.text()) != action) fuzz::fail("another action comes back of " + action.text());
      });
    for (std::size_t word = 0; word <= action.words.size(); ++word) {
      one([&] { action.number(word); });
      one([&] { action.whole(word, 1000000); });
    }
    at = end + 1;
  }
  return 0;
}
