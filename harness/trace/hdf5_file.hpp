// The one place that talks to HDF5: files made of groups, of datasets that grow row by row, and of
// attributes. None of HDF5's types are in this interface.
//
//   auto file = Hdf5File::create("a.h5");
//   file.create_dataset({.path = "/plant/time", .axes = {"step"}, .units = {"s"}});
//   file.begin_streaming();                // from here on a killed process leaves a readable file
//   file.append("/plant/time", times);
//   file.flush();
//   file.close();
//
// HDF5 as distributions package it is not safe for threads, so every call holds one lock of the
// process. A file being written uses HDF5's single-writer-multiple-reader mode: it orders writes so
// that the file on disk is consistent at every moment, where a plain flush leaves a file that is
// corrupt when the process dies between two flushes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// A dataset: its name, what a row is, and what it means. Its shape is rows x row_shape, and it
/// begins without rows.
struct DatasetSpec {
  enum class Type { kFloat64, kInt64, kText };

  std::string path;  ///< absolute, e.g. "/plant/state"
  Type type = Type::kFloat64;
  std::vector<std::size_t> row_shape{};  ///< empty where a row is one number
  std::vector<std::string> axes;         ///< attribute `axes`: a name for each dimension
  std::vector<std::string> units;        ///< attribute `units`: one for all, or one a column
  std::vector<std::string> columns{};    ///< attribute `columns`: names along the last axis
  std::string comment{};                 ///< attribute `comment`, where it is not empty
  std::size_t chunk_rows = 64;           ///< rows stored together
  bool compress = false;                 ///< shuffle and deflate
};

/// Bytes that an element of Type::kText has room for.
inline constexpr std::size_t kTextBytes = 32;

/// An open HDF5 file, either written from new or read. Movable; closes itself.
/// Every writing function throws IoError, every reading one InputError; both say the path and what
/// the system or HDF5 said.
class Hdf5File {
 public:
  /// A new file at `path`; what was there is overwritten.
  [[nodiscard]] static Hdf5File create(const std::string& path);
  /// The file at `path`, to be read; also one whose writer was killed. Throws IoError where the
  /// system refuses to read a file that exists.
  [[nodiscard]] static Hdf5File open(const std::string& path);

  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&& other) noexcept;
  ~Hdf5File();

  /// Makes the group and those above it.
  void create_group(const std::string& path);
  /// Makes the dataset and the groups above it.
  void create_dataset(const DatasetSpec& spec);
  /// Attributes of a group or dataset ("/" is the root); one that exists is replaced.
  void set_text(const std::string& object, const std::string& name, const std::string& value);
  void set_texts(const std::string& object, const std::string& name,
                 const std::vector<std::string>& values);
  /// At least one.
  void set_numbers(const std::string& object, const std::string& name,
                   std::span<const double> values);
  void set_integer(const std::string& object, const std::string& name, std::int64_t value);
  void set_unsigned(const std::string& object, const std::string& name, std::uint64_t value);

  /// From here on the file is consistent on disk at every moment, and no object or attribute can
  /// be made or changed until `end_streaming`.
  void begin_streaming();
  void end_streaming();

  /// Sets the number of columns of a rank-2 dataset that was made with none and has no rows yet.
  void set_columns(const std::string& path, std::size_t columns);
  /// Appends whole rows; `values.size()` is a multiple of a row's size (std::invalid_argument).
  void append(const std::string& path, std::span<const double> values);
  void append(const std::string& path, std::span<const std::int64_t> values);
  /// Throws std::invalid_argument on a text of more than `kTextBytes` bytes.
  void append(const std::string& path, std::span<const std::string> values);
  /// Hands everything that was appended to the system.
  void flush();
  /// Closes a written file for good; after it, the file may only be destroyed.
  void close();

  [[nodiscard]] const std::string& path() const;
  /// Whether the file's writer never closed it.
  [[nodiscard]] bool left_open_by_writer() const;
  [[nodiscard]] bool has_attribute(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& object, const std::string& name) const;
  /// What set_texts wrote.
  [[nodiscard]] std::vector<std::string> texts(const std::string& object,
                                               const std::string& name) const;
  /// What set_numbers wrote.
  [[nodiscard]] std::vector<double> numbers(const std::string& object,
                                            const std::string& name) const;
  [[nodiscard]] std::int64_t integer(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::uint64_t unsigned_integer(const std::string& object,
                                               const std::string& name) const;
  /// A group in the root.
  [[nodiscard]] bool has_group(const std::string& path) const;
  [[nodiscard]] bool has_dataset(const std::string& path) const;
  /// Lengths of a dataset's dimensions.
  [[nodiscard]] std::vector<std::size_t> shape(const std::string& path) const;
  /// All elements of a dataset, the last dimension fastest.
  [[nodiscard]] std::vector<double> doubles(const std::string& path) const;
  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& path) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& path) const;

 private:
  struct Impl;
  explicit Hdf5File(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace qsmpc::harness
