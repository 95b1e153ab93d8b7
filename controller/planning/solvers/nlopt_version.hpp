#pragma once

#include <string>

namespace qsmpc::controller {

/// Version of the linked NLopt, e.g. "2.7.1".
[[nodiscard]] std::string nlopt_version();

}  // namespace qsmpc::controller
