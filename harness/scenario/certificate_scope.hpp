// Whether the certificates of a scenario are bounds at all.
#pragma once

#include <string>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Why no certificate of `scenario` bounds the probability of being unsafe, in words that may
/// follow "no bound: "; empty where they do, for the model and for plants within its `model_error`.
/// With measurement noise and feedback the input depends on the noise, of which a certificate does
/// not know (docs/theory/certificates.md, section 4). Of a system without derivatives nothing is
/// known but that probabilities are at most 1.
[[nodiscard]] std::string why_no_bound(const Scenario& scenario);

}  // namespace qsmpc::harness
