#include "dreampm/import/vdb_file.h"

#include <openvdb/io/Archive.h>

#include <fstream>
#include <string>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"

namespace dreampm {
namespace {

/// openvdb::io::File checks that its file opens, and nothing that it writes. Here the stream is our
/// own; it can be sought in, so that programs may read one grid alone.
class Archive final : public openvdb::io::Archive {
 public:
  void put(std::ostream& out, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& about) const {
    write(out, grids, true, about);
  }
};

}  // namespace

void write_vdb_file(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
                    const openvdb::MetaMap& about) {
  replace_file(path, [&](const std::filesystem::path& temporary) {
    try {
      std::ofstream out;
      out.exceptions(std::ios::badbit | std::ios::failbit);  // the first write that fails is the end
      out.open(temporary, std::ios::binary | std::ios::trunc);
      Archive().put(out, grids, about);
      out.close();
    } catch (const std::ios::failure&) {
      fail_run("{}: cannot be written: {}", path.string(), system_reason());
    } catch (const openvdb::Exception& e) {
      fail_run("{}: cannot write the volume: {}", path.string(), e.what());
    }
  });
}

}  // namespace dreampm
