// The last bytes of an archive: a mark, its length and a checksum of all before. HDF5 1.10 reads
// beyond its own buffers when its tables are damaged, so it never gets to see a file whose seal is
// broken. Other HDF5 programs ignore the seal.
#pragma once
#include <filesystem>
#include <string>

namespace dreampm {

/// Appends the seal to `path`. Throws RunError naming `target`.
void seal_archive(const std::filesystem::path& path, const std::string& target);

/// Throws InputError if the file cannot be read, is empty, no HDF5, without a whole seal or not
/// what was sealed.
void check_archive_seal(const std::filesystem::path& path);

}  // namespace dreampm
