// The programs that a job can be written for.
#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "dreampm/farm/job.h"

/// In the order of --help. A format NAME is a row here, and a file of this folder that defines
/// NAME_format.
#define DM_FARM_FORMATS(FORMAT) FORMAT(openjd) FORMAT(slurm) FORMAT(make)

namespace dreampm::farm {

struct Format {
  std::string name;
  std::string about;  ///< for --help
  std::string file;   ///< its name in the job's folder
  std::string (*text)(const Job& job);
  /// What starts the job, as a line of a shell, of its file.
  std::string (*start)(const Job& job, const std::filesystem::path& file);
};

#define DM_DECLARE(name) Format name##_format();
DM_FARM_FORMATS(DM_DECLARE)
#undef DM_DECLARE

std::span<const Format> formats();

}  // namespace dreampm::farm
