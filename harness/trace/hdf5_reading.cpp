// Hdf5File: reading of datasets and attributes from files that may be damaged or hostile.
#include <algorithm>
#include <cstring>

#include "harness/errors.hpp"
#include "harness/trace/hdf5_file.hpp"
#include "harness/trace/hdf5_handle.hpp"
#include "harness/trace/hdf5_impl.hpp"

namespace qsmpc::harness {
namespace {

using hdf5::Handle;
using hdf5::Lock;
using hdf5::text_type;

/// More elements than this (4 GiB) in one dataset indicate a damaged or hostile file.
constexpr hsize_t kElementLimit = hsize_t{1} << 29;

/// Splits `padded` into texts of `length` bytes each; shorter ones are padded with zeros.
std::vector<std::string> texts_in(const std::string& padded, std::size_t length) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < padded.size(); at += length) {
    texts.emplace_back(padded.data() + at, ::strnlen(padded.data() + at, length));
  }
  return texts;
}

}  // namespace

void Hdf5File::Impl::read_attribute(const std::string& object, const std::string& name, hid_t type,
                                    hsize_t count, void* values) const {
  const std::string what = object + "@" + name;
  const Handle attribute = attribute_of(object, name);
  const Handle stored = checked(H5Aget_type(attribute.get()), H5Tclose, what);
  const Handle space = checked(H5Aget_space(attribute.get()), H5Sclose, what);
  // H5Aread writes through `values`: the attribute must have exactly `count` elements of this type.
  if (H5Tget_class(stored.get()) != H5Tget_class(type) ||
      H5Tis_variable_str(stored.get()) != H5Tis_variable_str(type) ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(count)) {
    throw InputError({.file = path,
                      .key = what,
                      .found = "a different type of attribute",
                      .expected = H5Tget_class(type) == H5T_STRING  ? "one string"
                                  : H5Tget_class(type) == H5T_FLOAT ? "floating-point numbers"
                                                                    : "one integer"});
  }
  check(H5Aread(attribute.get(), type, values), what);
}

/// Number of elements, capped at the number that may be read; `read_attribute` rejects an attribute
/// with a different number.
hsize_t Hdf5File::Impl::attribute_length(const std::string& object, const std::string& name,
                                         std::size_t element_bytes) const {
  const Handle attribute = attribute_of(object, name);
  const Handle space = checked(H5Aget_space(attribute.get()), H5Sclose, object + "@" + name);
  return std::min(kElementLimit / element_bytes,
                  static_cast<hsize_t>(H5Sget_simple_extent_npoints(space.get())));
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
                      .found = "a different type of attribute",
                      .expected = "one string of fixed length"});
  }
  return H5Tget_size(stored.get());
}

hsize_t Hdf5File::Impl::readable_elements(const std::string& name, H5T_class_t wanted) {
  const Handle type = checked(H5Dget_type(dataset(name)), H5Tclose, name);
  if (H5Tget_class(type.get()) != wanted) {
    throw InputError({.file = path,
                      .key = name,
                      .found = "a different type of element",
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

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  const Lock lock;
  return H5Aexists_by_name(impl_->file.get(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5File::has_group(const std::string& path) const { return has_dataset(path); }

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
  const hsize_t count = impl_->attribute_length(object, name, bytes);
  std::string padded(count * bytes, '\0');
  impl_->read_attribute(object, name, text_type(bytes).get(), count, padded.data());
  return texts_in(padded, bytes);
}

std::vector<double> Hdf5File::numbers(const std::string& object, const std::string& name) const {
  const Lock lock;
  std::vector<double> values(impl_->attribute_length(object, name, sizeof(double)));
  impl_->read_attribute(object, name, H5T_NATIVE_DOUBLE, values.size(), values.data());
  return values;
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
                      .found = "strings of variable length",
                      .expected = "strings of fixed length"});
  }
  std::string bytes(count * kTextBytes, '\0');
  impl_->check(H5Dread(impl_->dataset(path), text_type(kTextBytes).get(), H5S_ALL, H5S_ALL,
                       H5P_DEFAULT, bytes.data()),
               path);
  return texts_in(bytes, kTextBytes);
}

}  // namespace qsmpc::harness
