#include "harness/mismatch/measured_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::array<int, 3> kOrders = {2, controller::kHigherOrders[0],
                                        controller::kHigherOrders[1]};
constexpr Eigen::Index kAll = std::numeric_limits<Eigen::Index>::max();  // columns
// Replicates use the random numbers of path numbers that are too high to occur.
constexpr std::uint64_t kFirstReplicate = std::uint64_t{1} << 63;

/// Sums over the columns of a unit, as the bootstrap needs them: one row per unit, and one column
/// per period (or one for all periods), coordinate and order. The powers are of values that `scale`
/// brings to at most 1.
struct PowerSums {
  Eigen::Index groups = 1;  // periods, or 1
  Eigen::Index dim = 0;
  Eigen::VectorXd scale;     // dim
  Eigen::MatrixXd counts{};  // units x groups
  Eigen::MatrixXd sums{};    // units x (groups · dim · orders)

  [[nodiscard]] Eigen::Index column(Eigen::Index group, Eigen::Index i, std::size_t order) const {
    return (group * dim + i) * static_cast<Eigen::Index>(kOrders.size()) +
           static_cast<Eigen::Index>(order);
  }
};

Eigen::VectorXd largest_by_row(const std::vector<Eigen::MatrixXd>& units) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(units.front().rows());
  for (const Eigen::MatrixXd& unit : units) {
    for (const auto& column : unit.colwise()) {
      if (column.allFinite()) largest = largest.cwiseMax(column.cwiseAbs());
    }
  }
  return largest;
}

PowerSums power_sums(const ResidualSample& sample) {
  PowerSums powers{.dim = sample.units.front().rows(), .scale = largest_by_row(sample.units)};
  if (sample.by_period) {
    for (const Eigen::MatrixXd& unit : sample.units) {
      powers.groups = std::max(powers.groups, (unit.cols() + sample.stretch - 1) / sample.stretch);
    }
  }
  const auto units = std::ssize(sample.units);
  powers.counts = Eigen::MatrixXd::Zero(units, powers.groups);
  powers.sums = Eigen::MatrixXd::Zero(units, powers.column(powers.groups, 0, 0));
  for (Eigen::Index u = 0; u < units; ++u) {
    const Eigen::MatrixXd& unit = sample.units[static_cast<std::size_t>(u)];
    for (Eigen::Index k = 0; k < unit.cols(); ++k) {
      if (!unit.col(k).allFinite()) continue;
      const Eigen::Index group = sample.by_period ? k / sample.stretch : 0;
      powers.counts(u, group) += 1.0;
      for (Eigen::Index i = 0; i < powers.dim; ++i) {
        if (powers.scale[i] == 0.0) continue;
        const double part = std::abs(unit(i, k)) / powers.scale[i];
        for (std::size_t p = 0; p < kOrders.size(); ++p) {
          powers.sums(u, powers.column(group, i, p)) += std::pow(part, kOrders[p]);
        }
      }
    }
  }
  return powers;
}

/// The number of times that each replicate draws each unit: replicates x units.
Eigen::MatrixXd draws(Eigen::Index units, std::uint64_t seed) {
  Eigen::MatrixXd times = Eigen::MatrixXd::Zero(kReplicates, units);
  for (int n = 0; n < kReplicates; ++n) {
    const Eigen::VectorXd uniform =
        models::uniform_sample(units, {.seed = seed,
                                       .episode = kFirstReplicate + static_cast<std::uint64_t>(n),
                                       .stream = models::RandomStream::kPrediction});
    for (const double u : uniform) {
      // u is in (0, 1].
      const auto drawn = static_cast<Eigen::Index>(std::ceil(u * static_cast<double>(units))) - 1;
      times(n, std::clamp<Eigen::Index>(drawn, 0, units - 1)) += 1.0;
    }
  }
  return times;
}

/// The upper limit of a norm, from the sample's norm and those of the replicates.
double upper_limit(double norm, std::vector<double> replicates) {
  if (norm == 0.0) return 0.0;
  std::erase_if(replicates, [](double value) { return !(value > 0.0); });
  if (replicates.empty()) return norm;
  std::sort(replicates.begin(), replicates.end());
  const auto beyond = static_cast<std::size_t>(kErrorTail * static_cast<double>(replicates.size()));
  const std::size_t rank = std::max<std::size_t>(beyond, 1) - 1;
  const double low = replicates[rank];
  const double high = replicates[replicates.size() - 1 - rank];
  return norm * std::max(norm / low, high / norm);
}

/// Upper limits of the norms, dim x orders, the largest over the groups.
Eigen::MatrixXd norm_limits(const ResidualSample& sample, std::uint64_t seed) {
  const PowerSums powers = power_sums(sample);
  if (powers.counts.sum() == 0.0) throw std::invalid_argument("model error: no samples");
  const Eigen::MatrixXd times = draws(powers.counts.rows(), seed);
  const Eigen::MatrixXd sums = times * powers.sums;
  const Eigen::MatrixXd counts = times * powers.counts;
  Eigen::MatrixXd limits = Eigen::MatrixXd::Zero(powers.dim, std::ssize(kOrders));
  for (Eigen::Index group = 0; group < powers.groups; ++group) {
    const double count = powers.counts.col(group).sum();
    if (count == 0.0) continue;
    for (Eigen::Index i = 0; i < powers.dim; ++i) {
      for (std::size_t p = 0; p < kOrders.size(); ++p) {
        const Eigen::Index column = powers.column(group, i, p);
        const double root = 1.0 / kOrders[p];
        const double norm = std::pow(powers.sums.col(column).sum() / count, root);
        std::vector<double> replicates;
        replicates.reserve(kReplicates);
        for (Eigen::Index n = 0; n < kReplicates; ++n) {
          replicates.push_back(std::pow(sums(n, column) / counts(n, group), root));
        }
        double& limit = limits(i, static_cast<Eigen::Index>(p));
        limit = std::max(limit, powers.scale[i] * upper_limit(norm, std::move(replicates)));
      }
    }
  }
  return limits;
}

Eigen::MatrixXd finite_columns(const ResidualSample& sample) {
  std::vector<Eigen::VectorXd> columns;
  for (const Eigen::MatrixXd& unit : sample.units) {
    for (const auto& column : unit.colwise()) {
      if (column.allFinite()) columns.emplace_back(column);
    }
  }
  Eigen::MatrixXd all(sample.units.front().rows(), std::ssize(columns));
  for (Eigen::Index k = 0; k < all.cols(); ++k) all.col(k) = columns[static_cast<std::size_t>(k)];
  return all;
}

/// Sets the norms of `error` to the largest upper limit of any sample.
void set_norms(controller::ModelError& error, const std::vector<ResidualSample>& samples,
               std::uint64_t seed) {
  Eigen::MatrixXd limits =
      Eigen::MatrixXd::Zero(samples.front().units.front().rows(), std::ssize(kOrders));
  for (const ResidualSample& sample : samples) {
    limits = limits.cwiseMax(norm_limits(sample, seed));
  }
  // Norms increase with their order; their confidence limits do so only approximately.
  for (Eigen::Index p = 1; p < limits.cols(); ++p) {
    limits.col(p) = limits.col(p).cwiseMax(limits.col(p - 1));
  }
  error.root_mean_square = limits.col(0);
  for (std::size_t k = 0; k < controller::kHigherOrders.size(); ++k) {
    error.higher[k] = limits.col(static_cast<Eigen::Index>(k) + 1);
  }
}

/// Up to `count` columns of every unit, from column `begin` on; samples without a finite column
/// there are left out.
std::vector<ResidualSample> columns_of(const std::vector<ResidualSample>& samples,
                                       Eigen::Index begin, Eigen::Index count) {
  std::vector<ResidualSample> parts;
  for (const ResidualSample& sample : samples) {
    ResidualSample part{.by_period = sample.by_period, .stretch = sample.stretch};
    bool finite = false;
    for (const Eigen::MatrixXd& unit : sample.units) {
      const Eigen::Index from = std::min(begin, unit.cols());
      part.units.emplace_back(unit.middleCols(from, std::min(count, unit.cols() - from)));
      for (const auto& column : part.units.back().colwise()) finite |= column.allFinite();
    }
    if (finite) parts.push_back(std::move(part));
  }
  return parts;
}

/// The model error of one period, to which all of `samples` belong.
controller::ModelError period_error(std::vector<ResidualSample> samples, std::uint64_t seed) {
  controller::ModelError error;
  Eigen::Index fewest = std::numeric_limits<Eigen::Index>::max();
  Eigen::VectorXd least;
  Eigen::VectorXd most;
  for (const ResidualSample& sample : samples) {
    const Eigen::MatrixXd columns = finite_columns(sample);
    const Eigen::VectorXd mean = columns.rowwise().mean();
    least = least.size() == 0 ? mean : Eigen::VectorXd(least.cwiseMin(mean));
    most = most.size() == 0 ? mean : Eigen::VectorXd(most.cwiseMax(mean));
    fewest = std::min(fewest, columns.cols());
  }
  const bool centred = fewest > 1;
  if (centred) {
    error.offset = 0.5 * (least + most);
    for (ResidualSample& sample : samples) {
      for (Eigen::MatrixXd& unit : sample.units) unit.colwise() -= error.offset;
    }
  }
  set_norms(error, samples, seed);
  if (!centred) return error;
  const auto count = static_cast<double>(fewest);
  return controller::widened(std::move(error), std::sqrt((count + 1.0) / (count - 1.0)));
}

}  // namespace

controller::ModelError measured_model_error(const std::vector<ResidualSample>& samples,
                                            std::uint64_t seed, Eigen::Index first) {
  if (samples.empty() || samples.front().units.empty()) {
    throw std::invalid_argument("model error: no samples");
  }
  for (const ResidualSample& sample : samples) {
    if (finite_columns(sample).cols() == 0) {
      throw std::invalid_argument("model error: no samples");
    }
  }
  controller::ModelError error = controller::model_error_of(finite_columns(samples.front()));
  const std::vector<ResidualSample> later = columns_of(samples, first, kAll);
  set_norms(error, later.empty() ? samples : later, seed);
  for (Eigen::Index period = 0; period < first; ++period) {
    const std::vector<ResidualSample> own = columns_of(samples, period, 1);
    if (own.empty()) break;  // no drive was that long
    error.first.push_back(period_error(own, seed));
  }
  return error;
}

}  // namespace qsmpc::harness
