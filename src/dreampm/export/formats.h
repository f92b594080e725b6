// The formats of export, and what their files share.
#pragma once
#include "dreampm/export/clip.h"

/// In the order of --help. A format NAME is a row here, and a file of this folder that defines
/// NAME_format.
#define DM_EXPORT_FORMATS(FORMAT) FORMAT(ply) FORMAT(obj) FORMAT(gltf) FORMAT(vtkhdf) FORMAT(vdb) FORMAT(usd)

namespace dreampm::exchange {

#define DM_DECLARE(name) Format name##_format();
DM_EXPORT_FORMATS(DM_DECLARE)
#undef DM_DECLARE

using WriteFrame = void (*)(const ClipInfo&, const ClipFrame&, const std::filesystem::path& folder);

/// Files of their own for each frame.
template <WriteFrame write>
class EachFrame final : public ClipWriter {
 public:
  EachFrame(const ClipInfo& clip, std::filesystem::path folder) : clip_(clip), folder_(std::move(folder)) {}
  void add(const ClipFrame& frame) override { write(clip_, frame, folder_); }

 private:
  ClipInfo clip_;
  std::filesystem::path folder_;
};
template <WriteFrame write>
std::unique_ptr<ClipWriter> each_frame(const ClipInfo& clip, const std::filesystem::path& folder) {
  return std::make_unique<EachFrame<write>>(clip, folder);
}

}  // namespace dreampm::exchange
