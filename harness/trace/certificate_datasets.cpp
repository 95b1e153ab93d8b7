#include "harness/trace/certificate_datasets.hpp"

#include <string>

#include "harness/trace/certificate_fields.hpp"
#include "harness/trace/rows.hpp"

namespace qsmpc::harness {

std::vector<DatasetSpec> certificate_layout(std::optional<std::size_t> horizon) {
  const std::vector<std::string> axes =
      horizon ? std::vector<std::string>{"step", "stage"} : std::vector<std::string>{"stage"};
  const auto stages = [&](std::size_t more) {
    return horizon ? std::vector<std::size_t>{*horizon + more} : std::vector<std::size_t>{};
  };
  std::vector<std::string> budget_axes = axes;
  budget_axes.emplace_back("source");
  std::vector<std::size_t> budget_shape = stages(1);
  budget_shape.push_back(kBudgetColumns.size());
  std::vector<DatasetSpec> layout;
  layout.push_back({.path = "/certificate/budget",
                    .row_shape = budget_shape,
                    .axes = budget_axes,
                    .units = {kStateNorm},
                    .columns = budget_column_names(),
                    .comment = kBudgetMeaning});
  const auto add_of_budget = [&](const char* path, const char* unit, const char* meaning) {
    layout.push_back(
        {.path = path, .row_shape = stages(1), .axes = axes, .units = {unit}, .comment = meaning});
  };
  add_of_budget(kModelErrorPath, kStateNorm, kModelErrorMeaning);
  add_of_budget(kDynamicsPath, kStateNorm, kDynamicsMeaning);
  add_of_budget("/certificate/lipschitz", "1", kLipschitzMeaning);
  const auto add_of_stages = [&](const std::string& path, const std::string& meaning) {
    layout.push_back(
        {.path = path, .row_shape = stages(0), .axes = axes, .units = {"1"}, .comment = meaning});
  };
  add_of_stages(kCertificateValuePath, kCertificateValueMeaning);
  for (const controller::CertificateEntry& entry : controller::certificate_entries()) {
    // Plans of a drive do not have the other bounds.
    if (horizon && !entry.in_control) continue;
    add_of_stages(certificate_path(entry), entry.meaning);
  }
  layout.push_back({.path = "/certificate/kind",
                    .type = DatasetSpec::Type::kText,
                    .row_shape = stages(0),
                    .axes = axes,
                    .units = {"1"},
                    .comment = kKindMeaning});
  return layout;
}

void append_certificates(Hdf5File& file, const std::vector<controller::StageBudget>& budgets,
                         const std::vector<controller::StageCertificate>& certificates) {
  std::vector<double> columns;
  for (const controller::StageBudget& stage : budgets) {
    for (const BudgetField& field : kBudgetColumns) columns.push_back(stage.*field.member);
  }
  file.append("/certificate/budget", columns);
  file.append(kModelErrorPath, column_of(budgets, &controller::StageBudget::model));
  file.append(kDynamicsPath, column_of(budgets, &controller::StageBudget::dynamics));
  file.append("/certificate/lipschitz", column_of(budgets, &controller::StageBudget::lipschitz));
  file.append(kCertificateValuePath, column_of(certificates, &controller::StageCertificate::value));
  for (const controller::CertificateEntry& entry : controller::certificate_entries()) {
    if (!file.has_dataset(certificate_path(entry))) continue;
    std::vector<double> column;
    column.reserve(certificates.size());
    for (const controller::StageCertificate& stage : certificates) {
      column.push_back(stage.of(entry.key));
    }
    file.append(certificate_path(entry), column);
  }
  file.append("/certificate/kind", column_of(certificates, &controller::StageCertificate::kind));
}

}  // namespace qsmpc::harness
