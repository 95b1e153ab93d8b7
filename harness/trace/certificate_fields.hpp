// The names that files use for the numbers of certificates and error budgets: a single list for
// writing, reading and documentation.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"

namespace qsmpc::harness {

struct BudgetField {
  const char* name;
  double controller::StageBudget::*member;
};

/// The columns of /certificate/budget.
inline constexpr std::array<BudgetField, 4> kBudgetColumns = {{
    {"belief", &controller::StageBudget::belief},
    {"noise", &controller::StageBudget::noise},
    {"compression", &controller::StageBudget::compression},
    {"total", &controller::StageBudget::total},
}};

[[nodiscard]] inline std::vector<std::string> budget_column_names() {
  std::vector<std::string> names(kBudgetColumns.size());
  std::ranges::transform(kBudgetColumns, names.begin(), &BudgetField::name);
  return names;
}

/// Path of the dataset of a bound, or of a value that is shown beside the bounds.
[[nodiscard]] inline std::string certificate_path(const controller::CertificateEntry& entry) {
  return "/certificate/" + entry.dataset;
}

inline constexpr const char* kCertificateValuePath = "/certificate/value";
inline constexpr const char* kCertificateValueMeaning =
    "smallest of the sound upper bounds of the probability that the state (the model's, or with a "
    "model_error the plant's) is unsafe; the first is that of stage 1";

inline constexpr const char* kDynamicsPath = "/certificate/dynamics";
/// The budget's share due to the scenario's model error. It is not one of the columns, so that
/// traces without it remain readable.
inline constexpr const char* kModelErrorPath = "/certificate/model";
/// Unit of a W2 distance.
inline constexpr const char* kStateNorm = "Euclidean norm of the state";
inline constexpr const char* kBudgetMeaning =
    "bounds of the W2 distance between the particles and the law of the state (the model's, or "
    "with a model_error the plant's); stage 0 is the present";
inline constexpr const char* kDynamicsMeaning =
    "part of the budget's total that is due to the dynamics stretching distances; already included "
    "in the other sources";
inline constexpr const char* kModelErrorMeaning =
    "W2 error that the scenario's model_error alone would give; 0 without one";
inline constexpr const char* kLipschitzMeaning =
    "bound of the closed loop's Lipschitz constant from this stage to the next; 1 at the last";
inline constexpr const char* kKindMeaning = "which bound the value is: c1, c2, c3, c4 or c5";

}  // namespace qsmpc::harness
