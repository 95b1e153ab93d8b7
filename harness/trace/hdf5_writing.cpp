// Hdf5File: writing of groups, datasets and attributes.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "harness/trace/hdf5_file.hpp"
#include "harness/trace/hdf5_handle.hpp"
#include "harness/trace/hdf5_impl.hpp"

namespace qsmpc::harness {
namespace {

using hdf5::Handle;
using hdf5::Lock;
using hdf5::text_type;

/// Deflate level: higher levels take longer and save less than 1 % on floating-point particles.
constexpr unsigned kDeflateLevel = 2;
/// Columns stored together in a dataset whose number of columns is set later.
constexpr hsize_t kOpenColumnChunk = 8;

}  // namespace

void Hdf5File::Impl::open_groups_above(const std::string& path_of_object) {
  for (auto at = path_of_object.find('/', 1); at != std::string::npos;
       at = path_of_object.find('/', at + 1)) {
    const std::string group = path_of_object.substr(0, at);
    if (H5Lexists(file.get(), group.c_str(), H5P_DEFAULT) > 0) continue;
    const Handle plain(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    // Creation times would make equal runs differ.
    check(H5Pset_obj_track_times(plain.get(), false), group);
    checked(H5Gcreate2(file.get(), group.c_str(), H5P_DEFAULT, plain.get(), H5P_DEFAULT), H5Gclose,
            group);
  }
}

void Hdf5File::Impl::set_attribute(const std::string& object, const std::string& name, hid_t type,
                                   hid_t space, const void* value) const {
  const std::string what = object + "@" + name;
  const Handle owner = checked(H5Oopen(file.get(), object.c_str(), H5P_DEFAULT), H5Oclose, what);
  if (H5Aexists(owner.get(), name.c_str()) > 0) check(H5Adelete(owner.get(), name.c_str()), what);
  const Handle made = checked(
      H5Acreate2(owner.get(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  check(H5Awrite(made.get(), type, value), what);
}

void Hdf5File::Impl::append_rows(const std::string& name, hid_t type, const void* values,
                                 std::size_t count) {
  std::vector<hsize_t> lengths = dimensions(name);
  hsize_t row = 1;
  for (std::size_t i = 1; i < lengths.size(); ++i) row *= lengths[i];
  if (row == 0 ? count != 0 : count % row != 0) {
    throw std::invalid_argument(name + ": " + std::to_string(count) +
                                " values are not a whole number of rows of " + std::to_string(row));
  }
  if (count == 0) return;
  std::vector<hsize_t> start(lengths.size(), 0);
  std::vector<hsize_t> block = lengths;
  start[0] = lengths[0];
  block[0] = count / row;
  lengths[0] += block[0];
  check(H5Dset_extent(dataset(name), lengths.data()), name);
  const Handle target = checked(H5Dget_space(dataset(name)), H5Sclose, name);
  check(H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                            nullptr),
        name);
  const Handle source = checked(
      H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose, name);
  check(H5Dwrite(dataset(name), type, source.get(), target.get(), H5P_DEFAULT, values), name);
}

void Hdf5File::create_group(const std::string& path) {
  const Lock lock;
  impl_->open_groups_above(path + "/");
}

void Hdf5File::create_dataset(const DatasetSpec& spec) {
  const Lock lock;
  impl_->open_groups_above(spec.path);
  std::vector<hsize_t> lengths = {0};
  std::vector<hsize_t> limits = {H5S_UNLIMITED};
  std::vector<hsize_t> chunk = {spec.chunk_rows};
  for (const std::size_t length : spec.row_shape) {
    lengths.push_back(length);
    limits.push_back(length == 0 ? H5S_UNLIMITED : length);
    chunk.push_back(length == 0 ? kOpenColumnChunk : length);
  }
  const int rank = static_cast<int>(lengths.size());
  const Handle space =
      impl_->checked(H5Screate_simple(rank, lengths.data(), limits.data()), H5Sclose, spec.path);
  const Handle creation = impl_->checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, spec.path);
  impl_->check(H5Pset_obj_track_times(creation.get(), false), spec.path);
  impl_->check(H5Pset_chunk(creation.get(), rank, chunk.data()), spec.path);
  if (spec.compress) {
    impl_->check(H5Pset_shuffle(creation.get()), spec.path);
    impl_->check(H5Pset_deflate(creation.get(), kDeflateLevel), spec.path);
  }
  const Handle text = text_type(kTextBytes);
  const hid_t type = spec.type == DatasetSpec::Type::kText    ? text.get()
                     : spec.type == DatasetSpec::Type::kInt64 ? H5T_STD_I64LE
                                                              : H5T_IEEE_F64LE;
  impl_->datasets.insert_or_assign(
      spec.path, impl_->checked(H5Dcreate2(impl_->file.get(), spec.path.c_str(), type, space.get(),
                                           H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                                H5Dclose, spec.path));
  set_texts(spec.path, "axes", spec.axes);
  if (spec.units.size() == 1) {
    set_text(spec.path, "units", spec.units.front());
  } else {
    set_texts(spec.path, "units", spec.units);
  }
  if (!spec.columns.empty()) set_texts(spec.path, "columns", spec.columns);
  if (!spec.comment.empty()) set_text(spec.path, "comment", spec.comment);
}

// Texts have a fixed length. Texts of variable length are stored in the global heap, the only part
// of a file without a checksum; a damaged heap can send the library into an endless loop.
void Hdf5File::set_text(const std::string& object, const std::string& name,
                        const std::string& value) {
  const Lock lock;
  const Handle type = text_type(std::max<std::size_t>(1, value.size()));
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  impl_->set_attribute(object, name, type.get(), space.get(), value.c_str());
}

void Hdf5File::set_texts(const std::string& object, const std::string& name,
                         const std::vector<std::string>& values) {
  const Lock lock;
  std::size_t longest = 1;
  for (const std::string& value : values) longest = std::max(longest, value.size());
  std::string padded(values.size() * longest, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::copy(values[i].begin(), values[i].end(), padded.begin() + i * longest);
  }
  const Handle type = text_type(longest);
  const hsize_t count = values.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  impl_->set_attribute(object, name, type.get(), space.get(), padded.data());
}

void Hdf5File::set_numbers(const std::string& object, const std::string& name,
                           std::span<const double> values) {
  const Lock lock;
  const hsize_t count = values.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  impl_->set_attribute(object, name, H5T_IEEE_F64LE, space.get(), values.data());
}

void Hdf5File::set_integer(const std::string& object, const std::string& name, std::int64_t value) {
  const Lock lock;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  impl_->set_attribute(object, name, H5T_STD_I64LE, space.get(), &value);
}

void Hdf5File::set_unsigned(const std::string& object, const std::string& name,
                            std::uint64_t value) {
  const Lock lock;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  impl_->set_attribute(object, name, H5T_STD_U64LE, space.get(), &value);
}

void Hdf5File::set_columns(const std::string& path, std::size_t columns) {
  const Lock lock;
  const std::array<hsize_t, 2> lengths = {0, columns};
  impl_->check(H5Dset_extent(impl_->dataset(path), lengths.data()), path);
}

void Hdf5File::append(const std::string& path, std::span<const double> values) {
  const Lock lock;
  impl_->append_rows(path, H5T_NATIVE_DOUBLE, values.data(), values.size());
}

void Hdf5File::append(const std::string& path, std::span<const std::int64_t> values) {
  const Lock lock;
  impl_->append_rows(path, H5T_NATIVE_INT64, values.data(), values.size());
}

void Hdf5File::append(const std::string& path, std::span<const std::string> values) {
  const Lock lock;
  std::string padded(values.size() * kTextBytes, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].size() > kTextBytes) {
      throw std::invalid_argument(path + ": \"" + values[i] + "\" is longer than " +
                                  std::to_string(kTextBytes) + " bytes");
    }
    std::copy(values[i].begin(), values[i].end(), padded.begin() + i * kTextBytes);
  }
  impl_->append_rows(path, text_type(kTextBytes).get(), padded.data(), values.size());
}

}  // namespace qsmpc::harness
