#include "dreampm/io/ply_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dreampm/import/ply_values.h"
#include "dreampm/math/srgb.h"

namespace dreampm {
namespace {

constexpr const char* color_parts[3] = {"red", "green", "blue"};
constexpr const char* color_name = "color";

bool is_whole(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

/// "vorticity" of "vorticity_x"; empty of others.
std::string vector_name(const std::string& property) {
  return property.size() > 2 && property.ends_with("_x") ? property.substr(0, property.size() - 2) : std::string();
}

}  // namespace

std::string ply_attribute_lines(const VertexAttributes& attributes) {
  std::string lines;
  for (const VertexAttribute& a : attributes) switch (a.kind) {
      case AttributeKind::number:
        lines += fmt::format("property float {}\n", a.name);
        break;
      case AttributeKind::whole:
        lines += fmt::format("property int {}\n", a.name);
        break;
      case AttributeKind::vector:
        for (const char axis : {'x', 'y', 'z'}) lines += fmt::format("property float {}_{}\n", a.name, axis);
        break;
      case AttributeKind::color:
        for (const char* part : color_parts) lines += fmt::format("property uchar {}\n", part);
        break;
    }
  return lines;
}

void write_ply_attributes(ByteSink& out, const VertexAttributes& attributes, std::size_t vertex) {
  for (const VertexAttribute& a : attributes)
    for (std::size_t c = 0; c < a.width(); ++c) {
      const float value = a.values[vertex * a.width() + c];
      if (a.kind == AttributeKind::color)
        out.value(srgb_byte(value));
      else if (a.kind == AttributeKind::whole)
        out.value(static_cast<std::int32_t>(std::lround(value)));
      else
        out.value(value);
    }
}

PlyAttributeReader::PlyAttributeReader(const PlyElement& vertex, const std::vector<std::size_t>& taken) {
  std::vector<bool> used(vertex.properties.size());
  for (const std::size_t p : taken) used[p] = true;
  if (const auto alpha = ply_index(vertex, "alpha")) used[*alpha] = true;
  const auto add = [&](const std::string& name, AttributeKind kind, Columns columns) {
    for (const std::size_t p : columns.at) used[p] = true;
    attributes.push_back({name, kind, {}});
    attributes.back().values.reserve(static_cast<std::size_t>(vertex.count) * columns.at.size());
    columns_.push_back(std::move(columns));
  };
  const auto color = ply_triple(vertex, color_parts[0], color_parts[1], color_parts[2]);
  for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
    if (used[p]) continue;
    const PlyProperty& property = vertex.properties[p];
    const std::string name = vector_name(property.name);
    const auto parts = name.empty()
                           ? std::nullopt
                           : ply_triple(vertex, (name + "_x").c_str(), (name + "_y").c_str(), (name + "_z").c_str());
    if (color && std::find(color->begin(), color->end(), p) != color->end())
      add(color_name, AttributeKind::color, {{color->begin(), color->end()}, is_whole(property.type)});
    else if (parts)
      add(name, AttributeKind::vector, {{parts->begin(), parts->end()}});
    else
      add(property.name, is_whole(property.type) ? AttributeKind::whole : AttributeKind::number, {{p}});
  }
}

void PlyAttributeReader::take(const std::vector<double>& values) {
  for (std::size_t a = 0; a < columns_.size(); ++a)
    for (const std::size_t at : columns_[a].at) {
      const double value = attributes[a].kind != AttributeKind::color ? values[at]
                           : columns_[a].bytes                        ? linear_from_srgb(values[at] / 255)
                                                                      : linear_from_srgb(values[at]);
      attributes[a].values.push_back(static_cast<float>(value));
    }
}

}  // namespace dreampm
