// Conversion between the library's matrices, with samples as columns, and NumPy's arrays, with
// samples as rows.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

namespace qsmpc::python {

/// Rows are contiguous, as in NumPy.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <class Number = double>
using Array = nanobind::ndarray<nanobind::numpy, Number>;

/// An array of shape `shape` that owns `values`, whose size must match.
template <class Number>
[[nodiscard]] Array<Number> array_of(std::vector<Number> values,
                                     std::initializer_list<std::size_t> shape) {
  auto owned = std::make_unique<std::vector<Number>>(std::move(values));
  Number* const data = owned->data();
  const nanobind::capsule owner(owned.get(), [](void* pointer) noexcept {
    delete static_cast<std::vector<Number>*>(pointer);  // NOLINT(cppcoreguidelines-owning-memory)
  });
  (void)owned.release();
  return Array<Number>(data, shape.size(), shape.begin(), owner);
}

/// The columns of `samples` as rows.
[[nodiscard]] inline RowMatrix as_rows(const Eigen::Ref<const Eigen::MatrixXd>& samples) {
  return samples.transpose();
}

/// The rows of `samples` as columns.
[[nodiscard]] inline Eigen::MatrixXd as_columns(const RowMatrix& samples) {
  return samples.transpose();
}

}  // namespace qsmpc::python
