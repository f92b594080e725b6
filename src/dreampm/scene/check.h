// A scene that a program built is checked as one of a file is.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/scene/parse.h"

namespace dreampm::scene {

/// The scene, completed, and what is wrong with it; problems have their path in the message and no
/// other place. It goes through the tables that files go through, so that every rule is there once.
/// Reads no file.
ParseResult check_scene(const model::Scene& given);

/// Throws InputError for a shape that no collider may have; `name` is for the message. It may lie
/// anywhere.
void check_shape(const Shape& shape, const std::string& name);

/// The sentence of a key of the scene's tables: "space.spacing", "bodies.velocity". Empty for one
/// that there is not.
std::string meaning_of(std::string_view path);

/// Functions that write the YAML of a shape, of a material and of a look, as in a scene file.
/// `name` is the file's in messages, and models are looked for in its folder. Throw InputError.
std::string shape_text(const Shape& shape);
Shape parse_shape_text(std::string_view text, const std::string& name);
model::Material parse_material_text(std::string_view text, const std::string& name);
model::Look parse_look_text(std::string_view text, const std::string& name);

}  // namespace dreampm::scene
