// The entries of the table of methods (law_propagator.hpp). Each is defined in the file of its
// name.
#pragma once

#include <vector>

#include "controller/laws/law_propagator.hpp"

namespace qsmpc::controller {

[[nodiscard]] LawMethod monte_carlo_law();
[[nodiscard]] LawMethod unscented_law();
[[nodiscard]] LawMethod polynomial_chaos_law();
[[nodiscard]] LawMethod gaussian_mixture_law();
[[nodiscard]] LawMethod linearised_law();
[[nodiscard]] std::vector<LawMethod> quantised_laws();

}  // namespace qsmpc::controller
