// Norms ‖X‖_p = (E|X|^p)^{1/p} of polynomials of a standard normal Z, for even p.
#pragma once

namespace qsmpc::controller {

/// ‖Z^power‖_order = ((power · order − 1)!!)^{1/order}. order even, ≥ 2; power ≥ 1.
[[nodiscard]] double normal_power_norm(int power, int order);

/// ‖Z² − 1‖_order. order even, ≥ 2.
[[nodiscard]] double normal_square_norm(int order);

/// ‖Z³ − 3Z‖_order. order even, ≥ 2.
[[nodiscard]] double normal_cube_norm(int order);

}  // namespace qsmpc::controller
