// Hdf5File: opening and closing files. Their content is written in hdf5_writing.cpp and read in
// hdf5_reading.cpp.
#include "harness/trace/hdf5_file.hpp"

#include <utility>

#include "harness/errors.hpp"
#include "harness/files/random_access_file.hpp"
#include "harness/trace/hdf5_handle.hpp"
#include "harness/trace/hdf5_impl.hpp"

namespace qsmpc::harness {
namespace {

using hdf5::Handle;
using hdf5::Lock;

/// Nothing with a checksum crosses a boundary of this many bytes: a page of memory. If the process
/// is killed during a write that crosses a page boundary, the write is torn there; a write within
/// one page never is.
constexpr hsize_t kPage = 4096;
/// How often a wrong checksum is attributed to a concurrent writer and the read retried. HDF5
/// doubles its wait after each attempt, starting from 1 ns: 1 ms in total. Its default of 100
/// attempts would never end.
constexpr unsigned kReadAttempts = 20;

}  // namespace

Hdf5File::Hdf5File(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Hdf5File::Hdf5File(Hdf5File&& other) noexcept = default;
Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept = default;
Hdf5File::~Hdf5File() = default;

Hdf5File Hdf5File::create(const std::string& path) {
  const Lock lock;
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->writing = true;
  {
    // HDF5 would follow a symbolic link and truncate its target; RandomAccessFile refuses links.
    const RandomAccessFile plain(path);
  }
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  impl->check(H5Pset_obj_track_times(creation.get(), false), "/");
  impl->check(H5Pset_file_space_strategy(creation.get(), H5F_FSPACE_STRATEGY_PAGE,
                                         /*persist=*/false, /*threshold=*/1),
              "/");
  impl->check(H5Pset_file_space_page_size(creation.get(), kPage), "/");
  // Attributes go into a separate heap: in the object header a text could have at most 64 KiB.
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
  // This is the only mode in which HDF5 opens a file that its writer left open. It skips the check
  // of the file's length against the stored one, so it is used for nothing else.
  const unsigned flags = H5F_ACC_RDONLY | (impl->left_open ? H5F_ACC_SWMR_READ : 0U);
  const Handle access = hdf5::file_access();
  if (impl->left_open) {
    impl->check(H5Pset_metadata_read_attempts(access.get(), kReadAttempts), "the file");
  }
  impl->file = impl->checked(H5Fopen(path.c_str(), flags, access.get()), H5Fclose, "the file");
  return Hdf5File(std::move(impl));
}

void Hdf5File::begin_streaming() {
  const Lock lock;
  impl_->check(H5Fstart_swmr_write(impl_->file.get()), "the file");
}

void Hdf5File::end_streaming() {
  // Closing clears the superblock's flags of an open writer.
  close();
  const Lock lock;
  impl_->file = impl_->checked(
      H5Fopen(impl_->path.c_str(), H5F_ACC_RDWR, hdf5::file_access().get()), H5Fclose, "the file");
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

}  // namespace qsmpc::harness
