// The group /certificate: error budgets and certificates by stage, once or at every step.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

/// The datasets of the group. With `horizon`, a row is a step and holds all stages (budgets: 0 …
/// horizon, certificates: 1 … horizon); without it, a row is a stage.
[[nodiscard]] std::vector<DatasetSpec> certificate_layout(
    std::optional<std::size_t> horizon = std::nullopt);

/// Appends `budgets` (stages 0 … horizon) and `certificates` (stages 1 … horizon), as one step or
/// as one row per stage; bounds that the layout has no dataset for are skipped. Throws IoError.
void append_certificates(Hdf5File& file, const std::vector<controller::StageBudget>& budgets,
                         const std::vector<controller::StageCertificate>& certificates);

}  // namespace qsmpc::harness
