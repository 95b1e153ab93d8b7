#pragma once

#include <string>

namespace qsmpc::controller {

/// Of the NLopt that is linked, e.g. "2.7.1".
[[nodiscard]] std::string nlopt_version();

}  // namespace qsmpc::controller
