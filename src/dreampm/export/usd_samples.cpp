#include "dreampm/export/usd_samples.h"

#include <cctype>
#include <fstream>

#include "dreampm/base/error.h"

namespace dreampm::exchange {
namespace {

std::filesystem::path samples_file(std::filesystem::path target, std::size_t number) {
  return target += fmt::format(".{}", number);
}

}  // namespace

UsdSamples::UsdSamples(const std::filesystem::path& target, std::size_t number, std::string head, std::string metadata)
    : head_(std::move(head)),
      metadata_(std::move(metadata)),
      file_(samples_file(target, number)),
      out_(file_.temporary(), target) {}

void UsdSamples::begin(int frame) { out_.text(fmt::format("{}: [", frame)); }

void UsdSamples::copy_to(ByteSink& file, const std::string& indent) {
  out_.close();
  // Metadata belongs to the attribute's own declaration.
  file.text(fmt::format("{0}{1}{2}\n{0}{1}.timeSamples = {{\n", indent, head_,
                        metadata_.empty() ? "" : fmt::format(" ({})", metadata_)));
  std::ifstream in(file_.temporary(), std::ios::binary);
  std::vector<char> piece(buffered);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    file.bytes(piece.data(), static_cast<std::size_t>(in.gcount()));
  if (!in.eof()) fail_run("{}: cannot be read back: {}", file_.temporary().string(), system_reason());
  file.text(indent + "}\n");
}

std::string usd_name(const std::string& name) {
  std::string out;
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) ? "_" + out : out;
}

}  // namespace dreampm::exchange
