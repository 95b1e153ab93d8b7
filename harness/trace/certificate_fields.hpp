// The numbers of certificates and error budgets under the names that files use, so that what is
// written, read and documented is one list.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"

namespace qsmpc::harness {

struct CertificateField {
  const char* name;  ///< of the dataset, in the group /certificate
  double controller::StageCertificate::*member;
  const char* meaning;
};

inline constexpr std::array<CertificateField, 7> kCertificateFields = {{
    {"value", &controller::StageCertificate::value,
     "the least of the sound upper bounds of the probability that the state, the model's or with a "
     "model_error the plant's, is unsafe; the first is that of stage 1"},
    {"particles", &controller::StageCertificate::particles,
     "c1: worst case over the W2 ball around the particles; sound"},
    {"mixture", &controller::StageCertificate::mixture,
     "c2: the same before the last noise, which stays Gaussian; sound"},
    {"surrogate", &controller::StageCertificate::surrogate,
     "c3: affine-Gaussian surrogate, 1 where it does not apply; sound"},
    {"smoothed", &controller::StageCertificate::smoothed,
     "c4: the surrogate smoothed by the noise, 1 where it does not apply; sound"},
    {"thesis", &controller::StageCertificate::thesis,
     "the reference algorithm as printed; not sound"},
    {"unsafe_mass", &controller::StageCertificate::unsafe_mass,
     "weight of the particles that are unsafe; no bound"},
}};

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

[[nodiscard]] inline std::string certificate_path(const CertificateField& field) {
  return std::string("/certificate/") + field.name;
}

inline constexpr const char* kDynamicsPath = "/certificate/dynamics";
/// The budget's part that the scenario's model error has; not among the columns, so that traces
/// without it are read as they are.
inline constexpr const char* kModelErrorPath = "/certificate/model";
/// Unit of a W2 distance.
inline constexpr const char* kStateNorm = "Euclidean norm of the state";
inline constexpr const char* kBudgetMeaning =
    "bounds of the W2 distance between the particles and the law of the state, the model's or with "
    "a model_error the plant's; stage 0 is the present";
inline constexpr const char* kDynamicsMeaning =
    "how much of the budget's total is due to the dynamics stretching distances; a part of the "
    "other sources, not one beside them";
inline constexpr const char* kModelErrorMeaning =
    "W2 error that the scenario's model_error alone would give; 0 without one";
inline constexpr const char* kLipschitzMeaning =
    "bound of the closed loop's Lipschitz constant from this stage to the next; 1 at the last";
inline constexpr const char* kKindMeaning = "which bound the value is: c1, c2, c3 or c4";

}  // namespace qsmpc::harness
