// Grids of OpenVDB in files. For files that include OpenVDB themselves.
#pragma once
#include <openvdb/openvdb.h>

#include <filesystem>

namespace dreampm {

/// Writes the grids with what is said of them. The file appears whole or not at all. Throws
/// RunError with the system's reason if it cannot be written.
void write_vdb_file(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
                    const openvdb::MetaMap& about = {});

}  // namespace dreampm
