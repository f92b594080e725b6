// A chunk: some frames of a run, which one task of a farm makes beside others in the same folder.
// It writes the files of its frames, and notes about them in a folder of its own, so that no two
// tasks write to one file.
#pragma once
#include <filesystem>

#include "dreampm/pipeline/run_folder.h"

namespace dreampm {

/// The run with notes of its own for these frames, in chunks/FIRST-LAST; what an earlier call noted
/// there is known. Others may work on other frames of the run meanwhile. Throws InputError as
/// open_run does, for frames that are not simulated, and where another process holds the folder
/// alone or these very frames.
RunFolder open_chunk(const std::filesystem::path& folder, const FrameRange& frames);

/// The notes of STAGE that chunks have left in the folder.
std::vector<std::filesystem::path> chunk_tables(const std::filesystem::path& folder, const std::string& stage);

/// Takes what chunks noted into the tables of the folder, its log and `record`, and removes their
/// notes; saves the record if there were any. Only for who holds the folder alone.
void fold_chunks(const std::filesystem::path& folder, RunRecord& record);

}  // namespace dreampm
