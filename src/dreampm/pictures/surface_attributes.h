// What the vertices of a scene's surfaces hold (model::surface_attributes).
#pragma once
#include <vector>

#include "dreampm/geometry/vertex_attributes.h"
#include "dreampm/io/ply.h"
#include "dreampm/io/run_record.h"
#include "dreampm/model/scene.h"

namespace dreampm {

/// Values of the mesh of a material, as scene.surface.attributes names them, beside velocities,
/// which the mesh has. `frame`: the particles that it is of; `bodies`: as in run.json. Throws
/// InputError naming `file` where the frame lacks a column that an attribute is made of.
VertexAttributes surface_attributes(const model::Scene& scene, int material, const ParticleFrame& frame,
                                    const TriMesh& mesh, const std::vector<BodyRecord>& bodies,
                                    const std::string& file);

/// True if the scene's surfaces have that attribute.
bool has_surface_attribute(const model::Scene& scene, std::string_view name);

}  // namespace dreampm
