// The only interface to HDF5: files of groups, of datasets that grow row by row, and of attributes.
// It exposes none of HDF5's types.
//
//   auto file = Hdf5File::create("a.h5");
//   file.create_dataset({.path = "/plant/time", .axes = {"step"}, .units = {"s"}});
//   file.begin_streaming();                // from here on a killed process leaves a readable file
//   file.append("/plant/time", times);
//   file.flush();
//   file.close();
//
// HDF5 as packaged by distributions is not thread-safe, so every call holds one process-wide lock.
// A file being written uses HDF5's single-writer-multiple-reader mode, which orders writes so that
// the file on disk is consistent at every moment. With plain flushes alone, the file would be
// corrupt if the process died between two of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// A dataset: its name, the layout of a row, and its meaning. Its shape is rows x row_shape;
/// initially it has no rows.
struct DatasetSpec {
  enum class Type { kFloat64, kInt64, kText };

  std::string path;  ///< absolute, e.g. "/plant/state"
  Type type = Type::kFloat64;
  std::vector<std::size_t> row_shape{};  ///< empty if a row is one number
  std::vector<std::string> axes;         ///< attribute `axes`: a name for each dimension
  std::vector<std::string> units;        ///< attribute `units`: one for all, or one per column
  std::vector<std::string> columns{};    ///< attribute `columns`: names along the last axis
  std::string comment{};                 ///< attribute `comment`, unless empty
  std::size_t chunk_rows = 64;           ///< rows stored together
  bool compress = false;                 ///< shuffle and deflate
};

/// Size of an element of Type::kText, bytes.
inline constexpr std::size_t kTextBytes = 32;

/// An open HDF5 file, either newly written or read. Movable; closes itself.
/// Every writing function throws IoError, every reading function InputError; both give the path and
/// the message of the system or of HDF5.
class Hdf5File {
 public:
  /// Creates a file at `path`, overwriting any that exists.
  [[nodiscard]] static Hdf5File create(const std::string& path);
  /// Opens the file at `path` for reading, even one whose writer was killed. Throws IoError if the
  /// system refuses to read an existing file.
  [[nodiscard]] static Hdf5File open(const std::string& path);

  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&& other) noexcept;
  ~Hdf5File();

  /// Creates the group and its parents.
  void create_group(const std::string& path);
  /// Creates the dataset and its parent groups.
  void create_dataset(const DatasetSpec& spec);
  /// Sets an attribute of a group or dataset ("/" is the root), replacing one that exists.
  void set_text(const std::string& object, const std::string& name, const std::string& value);
  void set_texts(const std::string& object, const std::string& name,
                 const std::vector<std::string>& values);
  /// `values` is not empty.
  void set_numbers(const std::string& object, const std::string& name,
                   std::span<const double> values);
  void set_integer(const std::string& object, const std::string& name, std::int64_t value);
  void set_unsigned(const std::string& object, const std::string& name, std::uint64_t value);

  /// From here on the file is consistent on disk at every moment. No object or attribute can be
  /// created or changed until `end_streaming`.
  void begin_streaming();
  void end_streaming();

  /// Sets the number of columns of a rank-2 dataset that was created with none and has no rows yet.
  void set_columns(const std::string& path, std::size_t columns);
  /// Appends whole rows; throws std::invalid_argument unless `values.size()` is a multiple of a
  /// row's size.
  void append(const std::string& path, std::span<const double> values);
  void append(const std::string& path, std::span<const std::int64_t> values);
  /// Throws std::invalid_argument on a text of more than `kTextBytes` bytes.
  void append(const std::string& path, std::span<const std::string> values);
  /// Passes everything appended so far to the operating system.
  void flush();
  /// Closes a written file for good; afterwards the object may only be destroyed.
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
  /// Whether the root has the group `path`.
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
