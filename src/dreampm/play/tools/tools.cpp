#include <algorithm>

#include "dreampm/play/model/control.h"
#include "dreampm/play/tools/tool.h"

/// The one list of tools. Those that have a button stand in its order.
#define DM_TOOLS(tool)                                                                          \
  tool(push) tool(grab) tool(pour) tool(drop) tool(cut) tool(erase) tool(pin) tool(walls) /* */ \
      tool(turn) tool(shift) tool(shake)

namespace dreampm::play {

#define DM_DECLARE(name) std::unique_ptr<Tool> make_##name();
DM_TOOLS(DM_DECLARE)
#undef DM_DECLARE

ToolSet::ToolSet(){
#define DM_MAKE(name) tools_.push_back(make_##name());
    DM_TOOLS(DM_MAKE)
#undef DM_MAKE
}

ToolSet::ToolSet(const ToolSet& other) {
  for (const auto& tool : other) tools_.push_back(tool->clone());
}

Tool* ToolSet::find(std::string_view name) const {
  const auto own = std::find_if(begin(), end(), [&](const auto& tool) { return tool->info().name == name; });
  return own == end() ? nullptr : own->get();
}

const std::vector<ToolInfo>& tool_infos() {
  static const std::vector<ToolInfo> all = [] {
    std::vector<ToolInfo> infos;
    for (const auto& tool : ToolSet()) infos.push_back(tool->info());
    return infos;
  }();
  return all;
}

const std::vector<ToolInfo>& tool_buttons() {
  static const std::vector<ToolInfo> all = [] {
    std::vector<ToolInfo> infos = tool_infos();
    std::erase_if(infos, [](const ToolInfo& info) { return info.key == 0; });
    return infos;
  }();
  return all;
}

const std::vector<std::string>& tool_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const ToolInfo& info : tool_buttons()) all.emplace_back(info.name);
    return all;
  }();
  return names;
}

}  // namespace dreampm::play
