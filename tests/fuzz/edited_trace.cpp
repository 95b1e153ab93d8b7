#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <hdf5.h>

#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/report/episode_page.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/hdf5_file.hpp"
#include "harness/trace/hdf5_handle.hpp"
#include "harness/trace/summary.hpp"
#include "harness/trace/trace_csv.hpp"
#include "harness/trace/trace_file.hpp"
#include "tests/fuzz/edited_files.hpp"
#include "tests/fuzz/example_drive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {
namespace {

using namespace harness;
using hdf5::Handle;

constexpr hsize_t kMostElements = 100'000;

/// An HDF5 file under edit. Impossible edits are skipped.
class EditedFile {
 public:
  explicit EditedFile(const std::string& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, hdf5::file_access().get()), H5Fclose) {}

  void edit(const std::string& line) {
    std::istringstream words(line);
    std::string what;
    std::string object;
    if (!(words >> what >> object)) return;
    if (what == "set") set(object, words);
    if (what == "rows") set_rows(object, words);
    if (what == "shape") reshape(object, words);
    if (what == "drop") H5Ldelete(file_.get(), object.c_str(), H5P_DEFAULT);
    if (what == "text") set_text(object, words);
    if (what == "integer") set_integer(object, words);
    if (what == "scenario") replace_in_scenario(replacement(line));
  }

 private:
  [[nodiscard]] Handle dataset(const std::string& path) const {
    return {H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose};
  }

  void set(const std::string& path, std::istringstream& words) const {
    std::size_t index = 0;
    std::string value;
    const Handle set = dataset(path);
    if (!(words >> index >> value) || !set.ok()) return;
    const Handle type(H5Dget_type(set.get()), H5Tclose);
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get()));
    if (index >= count || count > kMostElements) return;
    std::vector<char> bytes(count * H5Tget_size(type.get()));
    const auto change = [&](hid_t memory, const auto& element) {
      using Element = std::decay_t<decltype(element)>;
      bytes.resize(count * sizeof(Element));
      if (H5Dread(set.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) return;
      reinterpret_cast<Element*>(bytes.data())[index] = element;
      H5Dwrite(set.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
    };
    const double number = std::strtod(value.c_str(), nullptr);
    switch (H5Tget_class(type.get())) {
      case H5T_FLOAT:
        change(H5T_NATIVE_DOUBLE, number);
        break;
      case H5T_INTEGER:
        change(H5T_NATIVE_INT64, std::strtoll(value.c_str(), nullptr, 10));
        break;
      case H5T_STRING: {
        if (H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) break;
        const std::size_t size = H5Tget_size(type.get());
        value.resize(size);
        std::copy(value.begin(), value.end(),
                  bytes.begin() + static_cast<std::ptrdiff_t>(index * size));
        H5Dwrite(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
        break;
      }
      default:
        break;
    }
  }

  void set_rows(const std::string& path, std::istringstream& words) const {
    hsize_t rows = 0;
    const Handle set = dataset(path);
    if (!(words >> rows) || rows > kMostElements || !set.ok()) return;
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    std::array<hsize_t, H5S_MAX_RANK> lengths{};
    if (H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr) < 1) return;
    lengths.front() = rows;
    H5Dset_extent(set.get(), lengths.data());
  }

  void reshape(const std::string& path, std::istringstream& words) const {
    std::vector<hsize_t> lengths;
    hsize_t all = 1;
    for (hsize_t length = 0; words >> length; lengths.push_back(length)) {
      all *= std::min(length, kMostElements + 1);
      if (all > kMostElements || lengths.size() > 8) return;
    }
    if (lengths.empty() || H5Ldelete(file_.get(), path.c_str(), H5P_DEFAULT) < 0) return;
    const Handle space(H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr),
                       H5Sclose);
    const Handle made(H5Dcreate2(file_.get(), path.c_str(), H5T_NATIVE_DOUBLE, space.get(),
                                 H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                      H5Dclose);
  }

  void put_attribute(const std::string& object, const std::string& name, hid_t type,
                     const void* value) const {
    H5Adelete_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate_by_name(file_.get(), object.c_str(), name.c_str(), type,
                                             space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    if (attribute.ok()) H5Awrite(attribute.get(), type, value);
  }

  void put_text(const std::string& object, const std::string& name, const std::string& text) const {
    const Handle type = hdf5::text_type(std::max<std::size_t>(1, text.size()));
    put_attribute(object, name, type.get(), text.c_str());
  }

  void set_text(const std::string& object, std::istringstream& words) const {
    std::string name;
    std::string value;
    if (!(words >> name)) return;
    std::getline(words >> std::ws, value);
    put_text(object, name, value);
  }

  void set_integer(const std::string& object, std::istringstream& words) const {
    std::string name;
    std::int64_t value = 0;
    if (words >> name >> value) put_attribute(object, name, H5T_NATIVE_INT64, &value);
  }

  void replace_in_scenario(const Replacement& text) {
    if (const auto at = scenario_.find(text.old); at != std::string::npos) {
      scenario_.replace(at, text.old.size(), text.with);
      put_text("/", "scenario", scenario_);
    }
  }

  Handle file_;
  std::string scenario_ = to_yaml(example_drive());
};

/// Produces everything that is made of a trace without a simulator.
void show(const Trace& trace) {
  const EpisodeView view(trace);
  (void)summary_json(view);
  (void)episode_csv(view);
  (void)plan_csv(view);
  (void)obstacles_csv(view);
  (void)particles_csv(view);
  (void)episode_page(view, {});
}

}  // namespace

void read_edited_trace(const std::string& edits) {
  static const TemporaryFolder folder;
  static const std::string sound = [] {
    std::string path = folder / "sound.h5";
    write_trace(path, run_episode(example_drive(), {}));
    return path;
  }();
  const std::string edited = folder / "edited.h5";
  std::filesystem::copy_file(sound, edited, std::filesystem::copy_options::overwrite_existing);
  {
    const hdf5::Lock quiet;
    EditedFile file(edited);
    std::istringstream lines(edits);
    for (std::string line; std::getline(lines, line);) file.edit(line);
  }
  Trace trace;
  try {
    trace = read_trace(edited);
  } catch (const InputError&) {
    return;
  }
  show(trace);
}

}  // namespace qsmpc::testing
