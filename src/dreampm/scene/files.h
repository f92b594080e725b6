// The files that a scene names: meshes and clouds of points of bodies, colliders and probes, the
// moment that it starts from, and the picture of what is around.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dreampm/model/scene.h"

namespace dreampm::scene {

/// Calls `each` with the path of every model that the shape names, so that it can be changed: a
/// file, or asset:NAME.
void each_model(Shape& shape, const std::function<void(std::string& path)>& each);
/// The same for all of a scene: shapes of bodies, colliders, regions of probes, its start, its
/// environment.
void each_model(model::Scene& scene, const std::function<void(std::string& path)>& each);

/// The files that a model consists of: itself, and the buffers that a .gltf or .gltf.gz names,
/// relative to its folder. Throws InputError for a .gltf that cannot be read and for a buffer that
/// is not there.
std::vector<std::filesystem::path> model_files(const std::filesystem::path& model);

/// The bytes of all of model_files, as 16 hexadecimal digits. Throws InputError for one that cannot
/// be read.
std::string model_hash(const std::filesystem::path& model);

}  // namespace dreampm::scene
