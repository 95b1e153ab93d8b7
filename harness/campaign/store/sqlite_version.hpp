#pragma once

#include <string>

namespace qsmpc::harness {

/// The version of the linked SQLite, e.g. "3.40.1".
[[nodiscard]] std::string sqlite_version();

}  // namespace qsmpc::harness
