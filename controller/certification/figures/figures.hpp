// The figures in the table of certificate_entries(). The functions that they return refer to the
// problem.
#pragma once

#include "controller/certification/certificate.hpp"

namespace qsmpc::controller {

/// C1: the worst case over the W2 ball about the particles.
[[nodiscard]] StageFigure particle_bound(const CertificateProblem& problem);

/// C2: the same before the last noise, which stays Gaussian.
[[nodiscard]] StageFigure mixture_bound(const CertificateProblem& problem);

/// C3: a Gaussian surrogate of the state, with a bound on their difference; 1 where nothing is
/// known about the derivatives.
[[nodiscard]] StageFigure surrogate_bound(const CertificateProblem& problem);

/// C4: the same, smoothed by noise that is independent of this error; never above C3.
[[nodiscard]] StageFigure smoothed_surrogate_bound(const CertificateProblem& problem);

/// C5: C3 and C4 conditioned on those functionals of the noise that make the motion most nonlinear,
/// summed over a grid of their values; 1 where the motion has a model error, and where C4 leaves
/// little to gain.
[[nodiscard]] StageFigure conditioned_bound(const CertificateProblem& problem);

/// What a stage adds to the probability of being unsafe at any stage so far (first_entry.hpp): the
/// sum over the stages is a bound, a single one is NOT.
[[nodiscard]] StageFigure first_entry_bound(const CertificateProblem& problem);

/// The thesis's probability (published_certificate.hpp): NOT a bound.
[[nodiscard]] StageFigure published_probability(const CertificateProblem& problem);

/// Weight of the particles that are unsafe: NOT a bound.
[[nodiscard]] StageFigure unsafe_mass(const CertificateProblem& problem);

}  // namespace qsmpc::controller
