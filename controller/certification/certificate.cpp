#include "controller/certification/certificate.hpp"

#include <algorithm>
#include <stdexcept>

#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"

namespace qsmpc::controller {

const std::vector<CertificateEntry>& certificate_entries() {
  static const std::vector<CertificateEntry> table = {
      {.key = "c1",
       .dataset = "particles",
       .meaning = "c1: worst case over the W2 ball around the particles; sound",
       .prepare = particle_bound},
      {.key = "c2",
       .dataset = "mixture",
       .meaning = "c2: the same before the last noise, which stays Gaussian; sound",
       .is_last = true,
       .prepare = mixture_bound},
      {.key = "c3",
       .dataset = "surrogate",
       .meaning = "c3: affine-Gaussian surrogate, 1 where it does not apply; sound",
       .prepare = surrogate_bound},
      {.key = "c4",
       .dataset = "smoothed",
       .meaning = "c4: the surrogate smoothed by the noise, 1 where it does not apply; sound",
       .prepare = smoothed_surrogate_bound},
      {.key = "c5",
       .dataset = "conditioned",
       .meaning = "c5: c3 and c4 given the noise that makes the motion most nonlinear, summed; 1 "
                  "if not needed; sound",
       .in_control = false,
       .prepare = conditioned_bound},
      {.key = "entry",
       .dataset = "entry",
       .meaning = "entry: what a stage adds to the probability of being unsafe at any stage so far;"
                  " the sum over stages is sound, a single one is not a bound",
       .is_bound = false,
       .prepare = first_entry_bound},
      {.key = "thesis",
       .dataset = "thesis",
       .meaning = "the reference algorithm as printed; not sound",
       .is_bound = false,
       .prepare = published_probability},
      {.key = "unsafe_mass",
       .dataset = "unsafe_mass",
       .meaning = "weight of the unsafe particles; not a bound",
       .is_bound = false,
       .without = 0.0,
       .prepare = unsafe_mass},
  };
  return table;
}

std::size_t certificate_index(std::string_view key) {
  const std::vector<CertificateEntry>& table = certificate_entries();
  const auto is_it = [&](const CertificateEntry& entry) { return entry.key == key; };
  const auto found = std::find_if(table.begin(), table.end(), is_it);
  if (found == table.end()) {
    throw std::invalid_argument("no certificate is called '" + std::string(key) + "'");
  }
  return static_cast<std::size_t>(found - table.begin());
}

double StageCertificate::of(std::string_view key) const {
  const std::size_t index = certificate_index(key);
  return index < figures.size() ? figures[index] : certificate_entries()[index].without;
}

StageCertificate blank_certificate() {
  StageCertificate certificate;
  for (const CertificateEntry& entry : certificate_entries()) {
    certificate.figures.push_back(entry.without);
  }
  return certificate;
}

std::vector<StageCertificate> certify(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                      const std::vector<StageBudget>& budgets,
                                      CertificateEffort effort, const Executor& run) {
  const CertificateProblem problem(motion, unsafe, budgets, effort, run);
  const std::vector<CertificateEntry>& table = certificate_entries();
  std::vector<StageFigure> prepared;
  prepared.reserve(table.size());
  for (const CertificateEntry& entry : table) {
    const bool asked = entry.in_control || effort != CertificateEffort::kLeast;
    prepared.push_back(asked ? entry.prepare(problem) : StageFigure());
  }
  std::vector<StageCertificate> certificates(motion.policy.horizon(), blank_certificate());
  const auto stage = [&](int k) {
    StageCertificate& certificate = certificates[k];
    for (const bool last : {false, true}) {
      for (std::size_t i = 0; i < table.size(); ++i) {
        if (table[i].is_last != last || !prepared[i]) continue;
        const double figure = prepared[i](static_cast<std::size_t>(k), certificate.value);
        certificate.figures[i] = figure;
        if (table[i].is_bound) certificate.value = std::min(certificate.value, figure);
      }
    }
    // Among equal bounds, name the simplest.
    for (std::size_t i = table.size(); i-- > 0;) {
      if (!table[i].is_bound) continue;
      // Where no bound is a number up to 1, the value is 1 and any of them names it.
      if (certificate.figures[i] == certificate.value || certificate.kind.empty()) {
        certificate.kind = table[i].key;
      }
    }
  };
  run(static_cast<int>(certificates.size()), stage);
  return certificates;
}

double horizon_bound(const std::vector<StageCertificate>& certificates) {
  double stages = 0.0;
  double entries = 0.0;
  for (const StageCertificate& certificate : certificates) {
    stages += certificate.value;
    entries += certificate.of("entry");
  }
  return std::min({1.0, stages, entries});
}

}  // namespace qsmpc::controller
