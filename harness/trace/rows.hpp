// Conversion of matrices to the rows of numbers that datasets consist of.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace qsmpc::harness {

/// `matrix` with its rows one after the other.
template <class Matrix>
[[nodiscard]] std::vector<double> by_rows(const Matrix& matrix) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  }
  return values;
}

inline void append_to(std::vector<double>& values, const std::vector<double>& more) {
  values.insert(values.end(), more.begin(), more.end());
}

/// `member` of every item.
template <class Item, class Value>
[[nodiscard]] std::vector<Value> column_of(const std::vector<Item>& items, Value Item::*member) {
  std::vector<Value> values;
  values.reserve(items.size());
  for (const Item& item : items) values.push_back(item.*member);
  return values;
}

}  // namespace qsmpc::harness
