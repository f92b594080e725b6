#include <algorithm>
#include <cstring>

#include "dreampm/base/error.h"
#include "dreampm/io/archive_hdf5.h"
#include "dreampm/io/archive_seal.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

hid_t open_file(const fs::path& path, const std::string& name) {
  check_archive_seal(path);
  const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  if (id < 0) fail_input("{}: cannot be opened: {}", name, h5_reason());
  return id;
}

herr_t take_name(hid_t group, const char* name, const H5L_info_t*, void* out) {
  // H5Oget_info_by_name would be shorter, but HDF5 1.14 gives it other parameters.
  const hid_t object = H5Oopen(group, name, H5P_DEFAULT);
  if (object < 0) return -1;
  const H5I_type_t type = H5Iget_type(object);
  if (H5Oclose(object) < 0) return -1;
  if (type == H5I_DATASET) static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

}  // namespace

struct ArchiveReader::Impl {
  std::string name;
  std::uint64_t bytes;
  H5Handle file;
  std::string scene;

  explicit Impl(const fs::path& path) : name(path.string()), bytes(0), file(open_file(path, name), H5Fclose) {
    std::error_code ec;
    bytes = fs::file_size(path, ec);
    if (ec) fail_input("{}: cannot be read: {}", name, ec.message());
  }

  // The text attribute of the root, or nothing.
  std::string text_attribute(const char* key) const {
    const H5Handle a(H5Aopen(file, key, H5P_DEFAULT), H5Aclose);
    const H5Handle type(a.ok() ? H5Aget_type(a) : -1, H5Tclose);
    if (!type.ok() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) foreign(key);
    std::string text(std::min<std::size_t>(H5Tget_size(type), 1 << 16), '\0');
    if (text.size() != H5Tget_size(type) || H5Aread(a, type, text.data()) < 0) foreign(key);
    text.resize(std::strlen(text.c_str()));
    return text;
  }
  [[noreturn]] void foreign(const char* key) const {
    fail_input("{}: an HDF5 file, but not a dreampm archive: no \"{}\" that can be read", name, key);
  }
  template <ArchiveValue T>
  T number_attribute(hid_t object, const char* key) const {
    const H5Handle a(H5Aopen(object, key, H5P_DEFAULT), H5Aclose);
    const H5Handle type(a.ok() ? H5Aget_type(a) : -1, H5Tclose);
    T value{};
    if (!type.ok() || H5Tequal(type, h5_type<T>()) <= 0 || H5Aread(a, h5_type<T>(), &value) < 0) foreign(key);
    return value;
  }

  [[noreturn]] void damaged(const std::string& key, const std::string& why) const {
    fail_input("{}: {} is damaged: {}", name, key, why);
  }
  H5Handle open(const std::string& key) const {
    H5Handle set(H5Dopen2(file, key.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.ok()) {
      const std::string reason = h5_reason();  // the next call of HDF5 forgets it
      if (!exists(key)) fail_input("{}: {} is missing", name, key);
      damaged(key, reason);
    }
    return set;
  }
  // Every group on the way must exist, or HDF5 calls it an error.
  bool exists(const std::string& key) const {
    for (std::size_t at = key.find('/'); at != std::string::npos; at = key.find('/', at + 1))
      if (H5Lexists(file, key.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(file, key.c_str(), H5P_DEFAULT) > 0;
  }
  void take(const std::string& key, hid_t set, hid_t type, void* data, std::size_t size) const {
    if (size > 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) damaged(key, h5_reason());
  }
};

ArchiveReader::ArchiveReader(const fs::path& file, const std::string& format, std::uint32_t version) {
  const QuietHdf5 quiet;
  impl_ = std::make_unique<Impl>(file);
  const std::string found = impl_->text_attribute(archive_key::format);
  if (found != format) fail_input("{}: holds \"{}\", \"{}\" is wanted", impl_->name, found, format);
  const auto number = impl_->number_attribute<std::uint32_t>(impl_->file, archive_key::version);
  if (number != version)
    fail_input("{}: {} of version {}; this dreampm reads version {}", impl_->name, format, number, version);
  impl_->scene = impl_->text_attribute(archive_key::scene_hash);
}

ArchiveReader::~ArchiveReader() = default;

std::string ArchiveReader::format_of(const fs::path& file) {
  const QuietHdf5 quiet;
  return Impl(file).text_attribute(archive_key::format);
}

const std::string& ArchiveReader::scene_hash() const { return impl_->scene; }

void ArchiveReader::expect_scene(const std::string& hash) const {
  if (hash != impl_->scene)
    fail_input("{}: belongs to another scene: its hash is {}, this scene's is {}", impl_->name, impl_->scene, hash);
}

std::vector<std::string> ArchiveReader::keys() const {
  const QuietHdf5 quiet;
  std::vector<std::string> names;
  if (H5Lvisit(impl_->file, H5_INDEX_NAME, H5_ITER_INC, take_name, &names) < 0)
    fail_input("{}: damaged: {}", impl_->name, h5_reason());
  std::sort(names.begin(), names.end());
  return names;
}

bool ArchiveReader::has(const std::string& name) const {
  const QuietHdf5 quiet;
  return impl_->exists(name);
}

template <ArchiveValue T>
std::vector<T> ArchiveReader::read(const std::string& name) const {
  const QuietHdf5 quiet;
  const H5Handle set = impl_->open(name);
  const H5Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  if (!type.ok() || H5Tequal(type, h5_type<T>()) <= 0 || !space.ok() || H5Sget_simple_extent_ndims(space) != 1)
    fail_input("{}: {} is not an array of {}", impl_->name, name, h5_type_name<T>());
  hsize_t count = 0;
  H5Sget_simple_extent_dims(space, &count, nullptr);
  if (count > impl_->bytes / sizeof(T))  // before anything is allocated for it
    impl_->damaged(name, fmt::format("{} values claimed in a file of {} bytes", count, impl_->bytes));
  std::vector<T> values(static_cast<std::size_t>(count));
  impl_->take(name, set, h5_type<T>(), values.data(), values.size() * sizeof(T));
  return values;
}

template <ArchiveValue T>
std::vector<T> ArchiveReader::read(const std::string& name, std::size_t count) const {
  std::vector<T> values = read<T>(name);
  if (values.size() != count)
    fail_input("{}: {} has {} values, {} are wanted", impl_->name, name, values.size(), count);
  return values;
}

std::string ArchiveReader::text(const std::string& name) const {
  const QuietHdf5 quiet;
  const H5Handle set = impl_->open(name);
  const H5Handle type(H5Dget_type(set), H5Tclose);
  if (!type.ok() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    fail_input("{}: {} is not a text", impl_->name, name);
  const std::size_t size = H5Tget_size(type);
  if (size > impl_->bytes) impl_->damaged(name, fmt::format("a text of {} bytes claimed", size));
  std::string text(size, '\0');
  impl_->take(name, set, type, text.data(), text.size());
  text.resize(std::min(size, text.find_last_not_of('\0') + 1));
  return text;
}

void ArchiveReader::refuse(const std::string& name, const std::string& why) const { impl_->damaged(name, why); }

template std::vector<float> ArchiveReader::read(const std::string&) const;
template std::vector<double> ArchiveReader::read(const std::string&) const;
template std::vector<std::int32_t> ArchiveReader::read(const std::string&) const;
template std::vector<std::uint32_t> ArchiveReader::read(const std::string&) const;
template std::vector<std::uint64_t> ArchiveReader::read(const std::string&) const;
template std::vector<std::int64_t> ArchiveReader::read(const std::string&) const;
template std::vector<std::uint8_t> ArchiveReader::read(const std::string&) const;
template std::vector<float> ArchiveReader::read(const std::string&, std::size_t) const;
template std::vector<double> ArchiveReader::read(const std::string&, std::size_t) const;
template std::vector<std::int32_t> ArchiveReader::read(const std::string&, std::size_t) const;
template std::vector<std::uint32_t> ArchiveReader::read(const std::string&, std::size_t) const;
template std::vector<std::uint64_t> ArchiveReader::read(const std::string&, std::size_t) const;
template std::vector<std::int64_t> ArchiveReader::read(const std::string&, std::size_t) const;
template std::vector<std::uint8_t> ArchiveReader::read(const std::string&, std::size_t) const;

}  // namespace dreampm
