// meshes: a collider that deforms, a file per frame.
#include <filesystem>
#include <map>

#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {
namespace fs = std::filesystem;

/// The number in a file's name that a pattern like robot.####.ply stands for, or nothing: at least
/// as many digits as there are signs.
std::optional<long> number_in(const std::string& name, const std::string& before, const std::string& after,
                              std::size_t digits) {
  if (name.size() < before.size() + digits + after.size() || !name.starts_with(before) || !name.ends_with(after))
    return std::nullopt;
  const std::string number = name.substr(before.size(), name.size() - before.size() - after.size());
  if (number.size() > 9 || number.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  if (number.size() > digits && number[0] == '0') return std::nullopt;
  return std::stol(number);
}

/// The files of a pattern, in the order of their numbers; reports what is wrong.
std::vector<std::string> matching(Reading& in, const YamlNode& n, const std::string& path, const std::string& pattern) {
  const auto bad = [&](const std::string& why) {
    in.problems.error(n.at, fmt::format("{} is '{}': {}", path, pattern, why));
    return std::vector<std::string>{};
  };
  const fs::path given(pattern);
  const std::string name = given.filename().string();
  const std::size_t first = name.find('#'), last = name.find_last_of('#');
  if (first == std::string::npos || name.find_first_not_of('#', first) <= last)
    return bad("must have one row of # where the number of a file stands, like robot.####.ply");
  const std::string before = name.substr(0, first), after = name.substr(last + 1);
  for (const fs::path& folder : {fs::path(in.folder) / given.parent_path(), given.parent_path()}) {
    std::map<long, std::string> found;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, none))
      if (const auto number = number_in(entry.path().filename().string(), before, after, last - first + 1))
        found[*number] = (folder / entry.path().filename()).lexically_normal().string();
    if (found.empty()) continue;
    std::vector<std::string> files;
    for (auto& [number, file] : found) {
      if (number != found.begin()->first + static_cast<long>(files.size()))
        return bad(fmt::format("the file with number {} is missing", found.begin()->first + files.size()));
      files.push_back(std::move(file));
    }
    return files;
  }
  return bad("no such files, neither beside the scene nor in the working folder");
}

Field<MeshSequence> meshes() {
  return Field<MeshSequence>{"meshes",
                             [](Reading& in, const YamlNode& n, const std::string& path, MeshSequence& out) {
                               const int before = in.problems.errors();
                               if (n.kind != YamlNode::Kind::list) {
                                 if (const auto pattern = read_text(in.problems, n, path))
                                   out.files = matching(in, n, path, *pattern);
                               } else {
                                 for (std::size_t i = 0; i < n.items.size(); ++i) {
                                   const std::string name = fmt::format("{}[{}]", path, i);
                                   if (const auto file = read_text(in.problems, n.items[i], name))
                                     out.files.push_back(find_file(in, n.items[i], name, *file));
                                 }
                               }
                               if (in.problems.errors() == before && out.files.size() < 2)
                                 in.problems.error(
                                     n.at, fmt::format("{} has {} files: a sequence has two or more; give `mesh` for "
                                                       "one that stands",
                                                       path, out.files.size()));
                             },
                             [](const MeshSequence& s, const std::string& k, YamlNode& map) {
                               std::vector<YamlNode> items;
                               for (const std::string& file : s.files) items.push_back(write_text(file));
                               map.put(k, YamlNode::list(std::move(items)));
                             }}
      .must()
      .takes(either({text_info("a pattern such as robot.####.ply"), list_info(text_info("a file"), 2)}))
      .says("Mesh files by time, in place of another form: a pattern with # for the digits of a number, or a list.");
}

const Schema<MeshSequence>& sequence_schema() {
  static const Schema<MeshSequence> all{
      meshes(), number("fps", &MeshSequence::fps, above_zero("Hz")).says("Files a second; the first is at time 0."),
      number("scale", &MeshSequence::scale, above_zero())
          .takes(number_info(above_zero("m")))
          .says("The length of the files' unit.")};
  return all;
}

}  // namespace

bool is_sequence(const YamlNode& shape) { return shape.is_map() && shape.find("meshes"); }

void read_sequence(Reading& in, const YamlNode& node, const std::string& path, MeshSequence& out) {
  read_map(in, node, path, sequence_schema(), out);
}

ValueInfo sequence_info() { return map_of(sequence_schema(), "sequence of meshes"); }

YamlNode write_sequence(const MeshSequence& sequence) { return write_map(sequence, sequence_schema()); }

}  // namespace dreampm::scene
