// A reproduction as one self-contained HTML page: tables, claims and figures.
#pragma once

#include <string>

#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

[[nodiscard]] std::string results_page(const Reproduction& reproduction);

}  // namespace qsmpc::harness
