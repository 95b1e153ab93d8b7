#include "harness/prediction/path_collector.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace qsmpc::harness {

PathCollector::PathCollector(const controller::Policy& policy, std::int64_t kept)
    : policy_(policy) {
  const Eigen::Index dim = policy.states.rows();
  const auto horizon = static_cast<std::size_t>(policy.horizon());
  laws_.paths.assign(horizon, controller::Points::Zero(dim, kept));
  total_.assign(
      horizon, {.offsets = Eigen::VectorXd::Zero(dim), .squares = Eigen::MatrixXd::Zero(dim, dim)});
}

PathCollector::StageSums PathCollector::collect(Eigen::Index stage, std::int64_t first,
                                                const controller::Points& states) {
  controller::Points& kept = laws_.paths[static_cast<std::size_t>(stage) - 1];
  const std::int64_t count = std::min<std::int64_t>(states.cols(), kept.cols() - first);
  if (count > 0) kept.middleCols(first, count) = states.leftCols(count);
  const controller::Points centred = states.colwise() - Eigen::VectorXd(policy_.states.col(stage));
  return {.offsets = centred.rowwise().sum(), .squares = centred * centred.transpose()};
}

void PathCollector::add(std::int64_t batch, std::vector<StageSums> sums) {
  const std::scoped_lock lock(mutex_);
  waiting_.emplace(batch, std::move(sums));
  for (auto at = waiting_.begin(); at != waiting_.end() && at->first == next_;
       at = waiting_.erase(at), ++next_) {
    for (std::size_t k = 0; k < total_.size(); ++k) {
      total_[k].offsets += at->second[k].offsets;
      total_[k].squares += at->second[k].squares;
    }
  }
}

PathLaws PathCollector::laws(std::int64_t samples) {
  PathLaws laws = std::move(laws_);
  laws.samples = samples;
  const auto count = static_cast<double>(samples);
  for (std::size_t k = 0; k < total_.size(); ++k) {
    const Eigen::VectorXd offset = total_[k].offsets / count;
    laws.moments.push_back({.mean = policy_.states.col(static_cast<Eigen::Index>(k) + 1) + offset,
                            .covariance = total_[k].squares / count - offset * offset.transpose()});
  }
  return laws;
}

}  // namespace qsmpc::harness
