#include "dreampm/import/obj.h"

#include "dreampm/import/text_lines.h"

namespace dreampm {

Model parse_obj(std::string_view text, const std::string& name) {
  TextLines lines(text, name, '#', true);
  Model model;
  std::vector<std::uint32_t> polygon;
  while (lines.next()) {
    const std::vector<std::string_view>& words = lines.words();
    if (words[0] == "v") {
      const char* what = "a coordinate";
      model.vertices.push_back(
          {lines.number<double>(1, what), lines.number<double>(2, what), lines.number<double>(3, what)});
    } else if (words[0] == "f" || words[0] == "fo") {
      polygon.clear();
      for (std::size_t k = 1; k < words.size(); ++k) {
        const auto index =
            lines.number_in<std::int64_t>(words[k].substr(0, words[k].find('/')), "the index of a vertex");
        const auto count = static_cast<std::int64_t>(model.vertices.size());
        const std::int64_t at = index < 0 ? count + index : index - 1;
        if (at < 0 || at >= count)
          fail_input("{}:{}: a face names vertex {}, but {} are there so far (1 to {}, or -{} to -1)", name,
                     lines.line(), index, count, count, count);
        polygon.push_back(static_cast<std::uint32_t>(at));
      }
      add_polygon(model, polygon);
    }
  }
  return model;
}

}  // namespace dreampm
