// A reproduction as one HTML page: tables, claims and figures, nothing outside of it.
#pragma once

#include <string>

#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

[[nodiscard]] std::string results_page(const Reproduction& reproduction);

}  // namespace qsmpc::harness
