// The surface stage: particles of every material that is not drawn as spheres become a mesh, frame
// by frame.
#pragma once
#include "dreampm/pictures/draw.h"
#include "dreampm/pipeline/stage.h"

namespace dreampm {

/// surface/surface_000001.ply, or surface/NAME_000001.ply where several materials are meshed.
std::filesystem::path surface_file(const RunFolder& run, int material, int frame,
                                   const std::string& extension = ".ply");
/// What a frame's meshes depend on; `run` must outlive it.
std::function<Identity(int frame)> surface_identity(const RunFolder& run);

/// Why one of the frames has no mesh that is up to date, and what makes it; empty if all have.
std::string no_surface(const RunFolder& run, const std::vector<int>& frames);

/// For each meshed material, how far the volume that its particles take (surface/volume_taken.h) is
/// off theirs at rest, and that of the mesh off what they take, at the first frame and at worst:
/// lines for a person. So that a mesh is not blamed for liquid that has swollen, nor the liquid for
/// a mesh.
std::vector<std::string> volume_lines(const RunRecord& record);

/// Makes the meshes of these frames that are not up to date: PLY, and beside it OBJ if
/// surface.format says so, and a volume if surface.type does: surface_000001.vdb, a fog, or
/// surface-sdf_000001.vdb, a level set. Volumes of meshes and particles go into run.json.
StageResult surface_stage(RunFolder& run, const FrameRange& frames = {});

}  // namespace dreampm
