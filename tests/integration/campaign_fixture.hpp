// Small campaigns for the program, and the comparable part of their results.
#pragma once

#include <string>
#include <vector>

#include "tests/integration/process.hpp"

namespace qsmpc::testing {

/// A campaign file of short drives past a block, for two variants; `extra` is appended.
[[nodiscard]] std::string short_campaign(const TemporaryFolder& folder, int seeds,
                                         const std::string& extra = "");

/// Every row of the store in `folder` without timings, one per line.
[[nodiscard]] std::vector<std::string> rows_of(const std::string& folder);

/// The bytes of campaign.json and of the CSV files, without wall-clock values.
[[nodiscard]] std::string results_of(const std::string& folder);

/// The JSON file at `path` without its wall-clock values.
[[nodiscard]] std::string json_without_timings(const std::string& path);

/// Names, relative to `folder`, of all files below it with the ending `ending`.
[[nodiscard]] std::vector<std::string> files_below(const std::string& folder,
                                                   const std::string& ending);

/// A small in-memory file system if one can be mounted, else an ordinary folder.
class SmallDisk {
 public:
  explicit SmallDisk(std::string path, int kilobytes = 400);
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk();
  /// Options under which a process on it fails for lack of space.
  [[nodiscard]] ProcessOptions when_small() const;
  void grow() const;

 private:
  std::string path_;
  int kilobytes_;
  bool mounted_ = false;
};

}  // namespace qsmpc::testing
