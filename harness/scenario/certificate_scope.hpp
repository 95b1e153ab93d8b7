// Whether the certificates of a scenario are valid bounds.
#pragma once

#include <string>

#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Why no certificate of `scenario` bounds the probability of being unsafe, worded to follow
/// "no bound: "; empty where certificates are bounds, for the model and for plants within its
/// `model_error`. With measurement noise and feedback, the input depends on the noise, which a
/// certificate does not account for (docs/theory/certificates.md, section 4). For a system without
/// derivatives, only the trivial bound 1 is known.
[[nodiscard]] std::string why_no_bound(const Scenario& scenario);

}  // namespace qsmpc::harness
