// The group /certificate: error budgets and certificates by stage, once or at every step.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "harness/trace/hdf5_file.hpp"

namespace qsmpc::harness {

/// Its datasets. With `horizon`, a row is a step and holds all stages (0 … horizon of budgets,
/// 1 … horizon of certificates); without, a row is a stage.
[[nodiscard]] std::vector<DatasetSpec> certificate_layout(
    std::optional<std::size_t> horizon = std::nullopt);

/// Appends `budgets` of stages 0 … horizon and `certificates` of stages 1 … horizon: one step, or
/// all stages, as far as the layout has a dataset for them. Throws IoError.
void append_certificates(Hdf5File& file, const std::vector<controller::StageBudget>& budgets,
                         const std::vector<controller::StageCertificate>& certificates);

}  // namespace qsmpc::harness
