#pragma once

#include <string>

namespace qsmpc::harness {

/// Of the SQLite that is linked, e.g. "3.40.1".
[[nodiscard]] std::string sqlite_version();

}  // namespace qsmpc::harness
