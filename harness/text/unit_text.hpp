// Units as people read them.
#pragma once

#include <string>

namespace qsmpc::harness {

/// An SI symbol as it is printed: "m/s²" of "m/s^2".
[[nodiscard]] std::string printed_unit(std::string unit);

}  // namespace qsmpc::harness
