// Vectors, matrices and intervals as JSON.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

[[nodiscard]] inline nlohmann::ordered_json vector_json(const Eigen::VectorXd& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// An array of the rows.
[[nodiscard]] inline nlohmann::ordered_json rows_json(const Eigen::MatrixXd& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : matrix.rowwise()) rows.push_back(vector_json(row));
  return rows;
}

/// [lower, upper].
[[nodiscard]] inline nlohmann::ordered_json interval_json(const RateInterval& interval) {
  return {interval.lower, interval.upper};
}

/// Whether certificates are bounds, and if not, why: `why` is the result of why_no_bound.
[[nodiscard]] inline nlohmann::ordered_json scope_json(const std::string& why) {
  nlohmann::ordered_json json{{"holds", why.empty()}, {"reason", nullptr}};
  if (!why.empty()) json["reason"] = why;
  return json;
}

}  // namespace qsmpc::harness
