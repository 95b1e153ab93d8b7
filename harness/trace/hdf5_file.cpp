#include "harness/trace/hdf5_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

#include "harness/errors.hpp"
#include "harness/trace/hdf5_handle.hpp"

namespace qsmpc {
namespace {

using hdf5::Handle;
using hdf5::Lock;
using hdf5::text_type;

/// Deflate's level: higher ones take longer and gain under 1 % on floating-point particles.
constexpr unsigned kDeflateLevel = 2;
/// Columns stored together in a dataset whose number of columns is set later.
constexpr hsize_t kOpenColumnChunk = 8;
/// Nothing that has a checksum crosses a boundary of so many bytes: a page of memory. A write that
/// crosses one is torn there when the process is killed in it; one that does not is never.
constexpr hsize_t kPage = 4096;
/// How often a checksum that does not fit is taken for a writer at work. HDF5 waits twice as long
/// after each attempt, from 1 ns on: together 1 ms, where its own default of 100 never ends.
constexpr unsigned kReadAttempts = 20;
/// More elements than this (4 GiB) in one dataset come from a damaged or hostile file.
constexpr hsize_t kElementLimit = hsize_t{1} << 29;

/// Texts of `length` bytes each, shorter ones padded with zeros.
std::vector<std::string> texts_in(const std::string& padded, std::size_t length) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < padded.size(); at += length) {
    texts.emplace_back(padded.data() + at, ::strnlen(padded.data() + at, length));
  }
  return texts;
}

}  // namespace

struct Hdf5File::Impl {
  std::string path;
  bool writing = false;
  bool left_open = false;
  mutable bool failed = false;  ///< a write failed
  Handle file;
  std::map<std::string, Handle, std::less<>> datasets;  ///< opened so far

  ~Impl() {
    const Lock lock;
    // Closing a file whose disk is full makes HDF5 write again what it could not, fail again and
    // free half of what it holds; such a file is left to the end of the process.
    for (auto& [name, dataset] : datasets) let_go(dataset);
    let_go(file);
  }
  void let_go(Handle& handle) const {
    if (failed) {
      hdf5::abandon(handle);
    } else {
      handle.reset();
    }
  }

  [[noreturn]] void fail(const std::string& object) const {
    const std::string words = hdf5::error_words();
    H5Eclear2(H5E_DEFAULT);
    if (writing) {
      failed = true;
      throw IoError(path + ": cannot write " + object + ": " + words);
    }
    throw InputError(
        {.file = path, .key = object, .found = words, .expected = "a trace that is not damaged"});
  }
  void check(herr_t status, const std::string& object) const {
    if (status < 0) fail(object);
  }
  Handle checked(hid_t id, Handle::Close close, const std::string& object) const {
    if (id < 0) fail(object);
    return {id, close};
  }

  [[nodiscard]] hid_t dataset(const std::string& name) {
    const auto found = datasets.find(name);
    if (found != datasets.end()) return found->second.get();
    Handle opened = checked(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name);
    return datasets.emplace(name, std::move(opened)).first->second.get();
  }
  [[nodiscard]] std::vector<hsize_t> dimensions(const std::string& name) {
    const Handle space = checked(H5Dget_space(dataset(name)), H5Sclose, name);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank < 0) fail(name);
    std::vector<hsize_t> lengths(static_cast<std::size_t>(rank));
    check(H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr), name);
    return lengths;
  }
  void open_groups_above(const std::string& path_of_object);
  void set_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                     const void* value) const;
  [[nodiscard]] Handle attribute_of(const std::string& object, const std::string& name) const {
    return checked(
        H5Aopen_by_name(file.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose, object + "@" + name);
  }
  void read_scalar(const std::string& object, const std::string& name, hid_t type,
                   void* value) const {
    read_attribute(object, name, type, 1, value);
  }
  void read_attribute(const std::string& object, const std::string& name, hid_t type, hsize_t count,
                      void* values) const;
  [[nodiscard]] hsize_t attribute_length(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::size_t text_bytes(const std::string& object, const std::string& name) const;
  void append_rows(const std::string& name, hid_t type, const void* values, std::size_t count);
  [[nodiscard]] hsize_t readable_elements(const std::string& name, H5T_class_t wanted);
};

void Hdf5File::Impl::open_groups_above(const std::string& path_of_object) {
  for (auto at = path_of_object.find('/', 1); at != std::string::npos;
       at = path_of_object.find('/', at + 1)) {
    const std::string group = path_of_object.substr(0, at);
    if (H5Lexists(file.get(), group.c_str(), H5P_DEFAULT) > 0) continue;
    const Handle plain(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    // Times of creation would make equal runs differ.
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

void Hdf5File::Impl::read_attribute(const std::string& object, const std::string& name, hid_t type,
                                    hsize_t count, void* values) const {
  const std::string what = object + "@" + name;
  const Handle attribute = attribute_of(object, name);
  const Handle stored = checked(H5Aget_type(attribute.get()), H5Tclose, what);
  const Handle space = checked(H5Aget_space(attribute.get()), H5Sclose, what);
  // What follows writes through `values`, so it must not read more than so many of this type.
  if (H5Tget_class(stored.get()) != H5Tget_class(type) ||
      H5Tis_variable_str(stored.get()) != H5Tis_variable_str(type) ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(count)) {
    throw InputError({.file = path,
                      .key = what,
                      .found = "another type of attribute",
                      .expected = H5Tget_class(type) == H5T_STRING ? "one text" : "one integer"});
  }
  check(H5Aread(attribute.get(), type, values), what);
}

/// At most as many as may be read; `read_attribute` refuses where there are others.
hsize_t Hdf5File::Impl::attribute_length(const std::string& object, const std::string& name) const {
  const Handle attribute = attribute_of(object, name);
  const Handle space = checked(H5Aget_space(attribute.get()), H5Sclose, object + "@" + name);
  const hsize_t most = kElementLimit / text_bytes(object, name);
  return std::min(most, static_cast<hsize_t>(H5Sget_simple_extent_npoints(space.get())));
}

std::size_t Hdf5File::Impl::text_bytes(const std::string& object, const std::string& name) const {
  const std::string what = object + "@" + name;
  const Handle attribute = attribute_of(object, name);
  const Handle stored = checked(H5Aget_type(attribute.get()), H5Tclose, what);
  const bool fixed = H5Tget_class(stored.get()) == H5T_STRING &&
                     H5Tis_variable_str(stored.get()) == 0 && H5Tget_size(stored.get()) > 0;
  if (!fixed || H5Tget_size(stored.get()) > kElementLimit) {
    throw InputError({.file = path,
                      .key = what,
                      .found = "another type of attribute",
                      .expected = "one text of fixed length"});
  }
  return H5Tget_size(stored.get());
}

void Hdf5File::Impl::append_rows(const std::string& name, hid_t type, const void* values,
                                 std::size_t count) {
  std::vector<hsize_t> lengths = dimensions(name);
  hsize_t row = 1;
  for (std::size_t i = 1; i < lengths.size(); ++i) row *= lengths[i];
  if (row == 0 ? count != 0 : count % row != 0) {
    throw std::invalid_argument(name + ": " + std::to_string(count) +
                                " values are no whole number of rows of " + std::to_string(row));
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

hsize_t Hdf5File::Impl::readable_elements(const std::string& name, H5T_class_t wanted) {
  const Handle type = checked(H5Dget_type(dataset(name)), H5Tclose, name);
  if (H5Tget_class(type.get()) != wanted) {
    throw InputError({.file = path,
                      .key = name,
                      .found = "another type of element",
                      .expected = wanted == H5T_STRING    ? "texts"
                                  : wanted == H5T_INTEGER ? "integers"
                                                          : "floating-point numbers"});
  }
  hsize_t count = 1;
  for (const hsize_t length : dimensions(name)) {
    if (length > kElementLimit || (count *= length) > kElementLimit) {
      throw InputError({.file = path,
                        .key = name,
                        .found = "a dimension of " + std::to_string(length),
                        .expected = "at most 2^29 elements"});
    }
  }
  return count;
}

Hdf5File::Hdf5File(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Hdf5File::Hdf5File(Hdf5File&& other) noexcept = default;
Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept = default;
Hdf5File::~Hdf5File() = default;

Hdf5File Hdf5File::create(const std::string& path) {
  const Lock lock;
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->writing = true;
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  impl->check(H5Pset_obj_track_times(creation.get(), false), "/");
  impl->check(H5Pset_file_space_strategy(creation.get(), H5F_FSPACE_STRATEGY_PAGE,
                                         /*persist=*/false, /*threshold=*/1),
              "/");
  impl->check(H5Pset_file_space_page_size(creation.get(), kPage), "/");
  // Attributes in a heap of their own: in the header a text could have 64 KiB at most.
  impl->check(H5Pset_attr_phase_change(creation.get(), 0, 0), "/");
  const Handle access = hdf5::file_access();
  impl->file =
      Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
  if (!impl->file.ok()) {
    const std::string words = hdf5::error_words();
    H5Eclear2(H5E_DEFAULT);
    throw IoError(path + ": cannot create the file: " + words);
  }
  return Hdf5File(std::move(impl));
}

Hdf5File Hdf5File::open(const std::string& path) {
  const Lock lock;
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->left_open = hdf5::opened_for_writing(path);
  // HDF5 refuses to open a file that its writer left open in any other way, and in this one it does
  // not compare the file's length with the stored one, so that it serves for nothing else.
  const unsigned flags = H5F_ACC_RDONLY | (impl->left_open ? H5F_ACC_SWMR_READ : 0U);
  const Handle access = hdf5::file_access();
  if (impl->left_open) {
    impl->check(H5Pset_metadata_read_attempts(access.get(), kReadAttempts), "the file");
  }
  impl->file = impl->checked(H5Fopen(path.c_str(), flags, access.get()), H5Fclose, "the file");
  return Hdf5File(std::move(impl));
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

// Texts have a fixed length: those of variable length live in a global heap, the one part of a file
// that has no checksum, and a damaged one can make the library run in circles.
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

void Hdf5File::begin_streaming() {
  const Lock lock;
  impl_->check(H5Fstart_swmr_write(impl_->file.get()), "the file");
}

void Hdf5File::end_streaming() {
  // Closing is what clears the superblock's flags of an open writer.
  close();
  const Lock lock;
  impl_->file = impl_->checked(
      H5Fopen(impl_->path.c_str(), H5F_ACC_RDWR, hdf5::file_access().get()), H5Fclose, "the file");
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

void Hdf5File::flush() {
  const Lock lock;
  impl_->check(H5Fflush(impl_->file.get(), H5F_SCOPE_LOCAL), "the file");
}

void Hdf5File::close() {
  const Lock lock;
  for (auto& [name, dataset] : impl_->datasets) impl_->check(dataset.reset(), name);
  impl_->datasets.clear();
  impl_->check(impl_->file.reset(), "the file");
}

const std::string& Hdf5File::path() const { return impl_->path; }

bool Hdf5File::left_open_by_writer() const { return impl_->left_open; }

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  const Lock lock;
  return H5Aexists_by_name(impl_->file.get(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5File::has_dataset(const std::string& path) const {
  const Lock lock;
  return H5Lexists(impl_->file.get(), path.c_str(), H5P_DEFAULT) > 0;
}

std::string Hdf5File::text(const std::string& object, const std::string& name) const {
  const Lock lock;
  const std::size_t bytes = impl_->text_bytes(object, name);
  std::string value(bytes, '\0');
  impl_->read_scalar(object, name, text_type(bytes).get(), value.data());
  value.resize(::strnlen(value.data(), bytes));
  return value;
}

std::vector<std::string> Hdf5File::texts(const std::string& object, const std::string& name) const {
  const Lock lock;
  const std::size_t bytes = impl_->text_bytes(object, name);
  const hsize_t count = impl_->attribute_length(object, name);
  std::string padded(count * bytes, '\0');
  impl_->read_attribute(object, name, text_type(bytes).get(), count, padded.data());
  return texts_in(padded, bytes);
}

std::int64_t Hdf5File::integer(const std::string& object, const std::string& name) const {
  const Lock lock;
  std::int64_t value = 0;
  impl_->read_scalar(object, name, H5T_NATIVE_INT64, &value);
  return value;
}

std::uint64_t Hdf5File::unsigned_integer(const std::string& object, const std::string& name) const {
  const Lock lock;
  std::uint64_t value = 0;
  impl_->read_scalar(object, name, H5T_NATIVE_UINT64, &value);
  return value;
}

std::vector<std::size_t> Hdf5File::shape(const std::string& path) const {
  const Lock lock;
  const std::vector<hsize_t> lengths = impl_->dimensions(path);
  return {lengths.begin(), lengths.end()};
}

std::vector<double> Hdf5File::doubles(const std::string& path) const {
  const Lock lock;
  std::vector<double> values(impl_->readable_elements(path, H5T_FLOAT));
  impl_->check(H5Dread(impl_->dataset(path), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                       values.data()),
               path);
  return values;
}

std::vector<std::int64_t> Hdf5File::integers(const std::string& path) const {
  const Lock lock;
  std::vector<std::int64_t> values(impl_->readable_elements(path, H5T_INTEGER));
  impl_->check(
      H5Dread(impl_->dataset(path), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
      path);
  return values;
}

std::vector<std::string> Hdf5File::texts(const std::string& path) const {
  const Lock lock;
  const hsize_t count = impl_->readable_elements(path, H5T_STRING);
  const Handle stored = impl_->checked(H5Dget_type(impl_->dataset(path)), H5Tclose, path);
  if (H5Tis_variable_str(stored.get()) != 0) {
    throw InputError({.file = impl_->path,
                      .key = path,
                      .found = "texts of variable length",
                      .expected = "texts of fixed length"});
  }
  std::string bytes(count * kTextBytes, '\0');
  impl_->check(H5Dread(impl_->dataset(path), text_type(kTextBytes).get(), H5S_ALL, H5S_ALL,
                       H5P_DEFAULT, bytes.data()),
               path);
  return texts_in(bytes, kTextBytes);
}

}  // namespace qsmpc
