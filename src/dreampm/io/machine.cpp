#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <thread>

#include "dreampm/io/run_record.h"

namespace dreampm {
namespace {

// The text behind "key : " in a file of such lines, or nothing.
std::string field(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::size_t at = line.find_first_not_of(" \t", colon + 1);
    return at == std::string::npos ? std::string() : line.substr(at);
  }
  return {};
}

std::uint64_t number_in(const char* file) {
  std::ifstream in(file);
  std::uint64_t value = 0;
  return in >> value ? value : 0;  // "max" and a missing file both mean no limit
}

int usable_cores() {
#ifdef __linux__
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

// Inside a container this file is the container's own limit.
std::uint64_t group_limit() { return number_in("/sys/fs/cgroup/memory.max"); }

}  // namespace

std::uint64_t machine_memory_bytes() {
  const std::uint64_t all =
      static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  const std::uint64_t limit = group_limit();
  return limit ? std::min(all, limit) : all;
}

std::uint64_t available_memory_bytes() {
  const std::string text = field("/proc/meminfo", "MemAvailable");
  std::uint64_t free = machine_memory_bytes();
  if (!text.empty()) free = std::min<std::uint64_t>(free, std::strtoull(text.c_str(), nullptr, 10) * 1024);
  if (const std::uint64_t limit = group_limit()) {
    const std::uint64_t used = number_in("/sys/fs/cgroup/memory.current");
    free = std::min(free, limit > used ? limit - used : 0);
  }
  return free;
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t resident_memory_bytes() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t pages = 0, resident = 0;
  return in >> pages >> resident ? resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

bool restart_peak_memory() {
  std::ofstream out("/proc/self/clear_refs");
  return static_cast<bool>(out << "5" << std::flush);
}

MachineRecord this_machine(const std::string& isa, int threads) {
  MachineRecord m;
  m.cpu = field("/proc/cpuinfo", "model name");
  if (m.cpu.empty()) m.cpu = "unknown";
  m.cores = usable_cores();
  m.threads = threads;
  m.isa = isa;
  m.memory_bytes = machine_memory_bytes();
  return m;
}

}  // namespace dreampm
