// The implementation of Hdf5File, only for the sources of `hdf5_file.hpp`.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/errors.hpp"
#include "harness/trace/hdf5_file.hpp"
#include "harness/trace/hdf5_handle.hpp"

namespace qsmpc::harness {

/// Its functions require HDF5's lock to be held; they throw as Hdf5File does.
struct Hdf5File::Impl {
  std::string path;
  bool writing = false;
  bool left_open = false;
  mutable bool failed = false;  ///< a write failed
  hdf5::Handle file;
  std::map<std::string, hdf5::Handle, std::less<>> datasets;  ///< opened so far

  ~Impl() {
    const hdf5::Lock lock;
    // Closing a file on a full disk makes HDF5 retry the failed writes, fail again and free only
    // half of its resources. Such a file is left open until the process ends.
    for (auto& [name, dataset] : datasets) let_go(dataset);
    let_go(file);
  }
  void let_go(hdf5::Handle& handle) const {
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
        {.file = path, .key = object, .found = words, .expected = "an undamaged trace"});
  }
  void check(herr_t status, const std::string& object) const {
    if (status < 0) fail(object);
  }
  hdf5::Handle checked(hid_t id, hdf5::Handle::Close close, const std::string& object) const {
    if (id < 0) fail(object);
    return {id, close};
  }

  [[nodiscard]] hid_t dataset(const std::string& name) {
    const auto found = datasets.find(name);
    if (found != datasets.end()) return found->second.get();
    hdf5::Handle opened = checked(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, name);
    return datasets.emplace(name, std::move(opened)).first->second.get();
  }
  [[nodiscard]] std::vector<hsize_t> dimensions(const std::string& name) {
    const hdf5::Handle space = checked(H5Dget_space(dataset(name)), H5Sclose, name);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank < 0) fail(name);
    std::vector<hsize_t> lengths(static_cast<std::size_t>(rank));
    check(H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr), name);
    return lengths;
  }
  void open_groups_above(const std::string& path_of_object);
  void set_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                     const void* value) const;
  [[nodiscard]] hdf5::Handle attribute_of(const std::string& object,
                                          const std::string& name) const {
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
  [[nodiscard]] hsize_t attribute_length(const std::string& object, const std::string& name,
                                         std::size_t element_bytes) const;
  [[nodiscard]] std::size_t text_bytes(const std::string& object, const std::string& name) const;
  void append_rows(const std::string& name, hid_t type, const void* values, std::size_t count);
  [[nodiscard]] hsize_t readable_elements(const std::string& name, H5T_class_t wanted);
};

}  // namespace qsmpc::harness
