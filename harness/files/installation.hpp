// Where this program is installed, or the library that it is in.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// The file that this code is in: a program, or the shared library in someone else's. Empty where
/// the system does not tell.
[[nodiscard]] std::string own_object_file();

/// What may be the prefix that an object file is installed under, the nearest first:
/// PREFIX/bin/qsmpc, PREFIX/lib/libqsmpc.so, PREFIX/lib/ARCHITECTURE/libqsmpc.so; and for the
/// Python module PREFIX/_native/core.so, where a wheel is its own prefix, or
/// PREFIX/lib/python3/dist-packages/qsmpc/_native/core.so.
[[nodiscard]] std::vector<std::string> installation_prefixes_of(const std::string& object_file);

/// Those of own_object_file().
[[nodiscard]] std::vector<std::string> installation_prefixes();

}  // namespace qsmpc::harness
