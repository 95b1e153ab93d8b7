// The group /system: the names, units and input bounds of the system that was driven, so that a
// reader needs no model to know what the columns of the other groups are.
#pragma once

#include "harness/trace/hdf5_file.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Makes the group. Throws IoError.
void write_system(Hdf5File& file, const models::SystemDescription& system);

/// Whether the file has the group: traces of earlier versions do not.
[[nodiscard]] bool has_system(const Hdf5File& file);

/// Reads what `write_system` wrote. Throws InputError on a damaged or inconsistent group.
[[nodiscard]] models::SystemDescription read_system(const Hdf5File& file);

}  // namespace qsmpc::harness
