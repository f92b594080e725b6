// Files that are whole or absent: written to a temporary name beside the target, flushed, then
// renamed.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace dreampm {

/// Creates the folder and its parents. Throws InputError naming the path and the reason.
void make_folder(const std::filesystem::path& folder);

/// Throws InputError unless replace_file can write `target` later: the folder is there and takes a
/// file, and no folder has that name. Leaves nothing behind. For what would else fail at the end of
/// a long run.
void check_replaceable(const std::filesystem::path& target);

/// Calls `write(temporary)`; when it returns, renames the temporary file to `target`. On any
/// exception the temporary file is removed and an existing target is left as it was.
void replace_file(const std::filesystem::path& target,
                  const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes all bytes to `path` (not atomic: use inside replace_file). Throws RunError with the
/// reason: a full disk, a limit.
void write_bytes(const std::filesystem::path& path, const void* data, std::size_t size);

/// replace_file + write_bytes.
void replace_file_text(const std::filesystem::path& target, std::string_view text);

/// "STEM-001.png", or the next number of which there is no file yet.
std::filesystem::path free_name(const std::string& stem, std::string_view extension);

/// The whole file. Throws InputError if it cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace dreampm
