// Where this program is installed, or the library that it is in.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// The file that this code is in: a program, or the shared library in someone else's. Empty where
/// the system does not tell.
[[nodiscard]] std::string own_object_file();

/// What may be the prefix that it is installed under, the nearest first: PREFIX/bin/qsmpc,
/// PREFIX/lib/libqsmpc.so, PREFIX/lib/ARCHITECTURE/libqsmpc.so.
[[nodiscard]] std::vector<std::string> installation_prefixes();

}  // namespace qsmpc::harness
