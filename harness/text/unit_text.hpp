// Units formatted for people.
#pragma once

#include <string>

namespace qsmpc::harness {

/// An SI symbol as printed: "m/s²" for "m/s^2".
[[nodiscard]] std::string printed_unit(std::string unit);

}  // namespace qsmpc::harness
