#pragma once

#include <string>

namespace qsmpc::harness {

/// Version of the linked HDF5, e.g. "1.10.8".
[[nodiscard]] std::string hdf5_version();

}  // namespace qsmpc::harness
