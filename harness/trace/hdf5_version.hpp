#pragma once

#include <string>

namespace qsmpc::harness {

/// Of the HDF5 that is linked, e.g. "1.10.8".
[[nodiscard]] std::string hdf5_version();

}  // namespace qsmpc::harness
