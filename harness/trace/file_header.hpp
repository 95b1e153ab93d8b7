// What files of numbers say about themselves at their root.
#pragma once

#include <cstdint>
#include <string>

#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

struct FileHeader {
  std::string kind{};         ///< of file, e.g. "prediction"; empty: not said
  std::int64_t schema = 0;    ///< grows with every change that an older reader would misread
  std::string version;        ///< of the program
  std::string scenario_text;  ///< the resolved scenario as YAML
  std::string scenario_name;
  std::uint64_t seed = 0;
};

/// Writes it as attributes of "/". Throws IoError.
void write_file_header(Hdf5File& file, const FileHeader& header);

}  // namespace qsmpc::harness
