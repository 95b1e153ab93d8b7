// Where this program, or the library that contains this code, is installed.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// The file that contains this code: the program, or the shared library that another program
/// loaded. Empty if the system does not tell.
[[nodiscard]] std::string own_object_file();

/// Candidates for the prefix that an object file is installed under, the nearest first:
/// PREFIX/bin/qsmpc, PREFIX/lib/libqsmpc.so, PREFIX/lib/ARCHITECTURE/libqsmpc.so; and for the
/// Python module PREFIX/_native/core.so, where a wheel is its own prefix, or
/// PREFIX/lib/python3/dist-packages/qsmpc/_native/core.so.
[[nodiscard]] std::vector<std::string> installation_prefixes_of(const std::string& object_file);

/// The candidates for own_object_file().
[[nodiscard]] std::vector<std::string> installation_prefixes();

}  // namespace qsmpc::harness
