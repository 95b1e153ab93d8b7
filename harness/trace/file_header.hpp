// The metadata that numeric files carry as attributes of their root.
#pragma once

#include <cstdint>
#include <string>

#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

struct FileHeader {
  std::string kind{};         ///< of the file, e.g. "prediction"; empty if not stated
  std::int64_t schema = 0;    ///< incremented by every change that an older reader would misread
  std::string version;        ///< of the program
  std::string scenario_text;  ///< the resolved scenario as YAML
  std::string scenario_name;
  std::uint64_t seed = 0;
};

/// Writes `header` as attributes of "/". Throws IoError.
void write_file_header(Hdf5File& file, const FileHeader& header);

}  // namespace qsmpc::harness
