// Penalties that keep particles out of the unsafe set; terms of the cost (cost_terms.hpp).
//
// `thesis` is Algorithm 2 and Eq. 4-10 as printed: flat inside an obstacle, so that a particle in
// it is not pushed out, and with a halo one unit wide, whatever the unit. `smooth` is the default:
// with s the signed distance to a face of the bounds or to an obstacle (negative beyond or inside)
// and ℓ a stated length, the sum over all of them of
//
//     h(s) = 0 for s ≥ ℓ,  ½ (1 − s/ℓ)² for 0 ≤ s ≤ ℓ,  ½ − s/ℓ for s ≤ 0:
//
// continuously differentiable, ½ on the boundary, and growing with the depth inside, so that the
// gradient points outwards from everywhere.
#pragma once

#pragma GCC visibility push(default)

namespace qsmpc::controller {

enum class PenaltyShape { kSmooth, kThesis };

struct Penalty {
  PenaltyShape shape = PenaltyShape::kSmooth;
  double box = 450.0;       ///< weight of leaving the bounds, ≥ 0
  double obstacle = 400.0;  ///< weight of entering an obstacle, ≥ 0
  double length = 0.5;      ///< ℓ (m), > 0; `smooth` only
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
