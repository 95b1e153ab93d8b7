// Mixtures for the tests of MixtureSplitter.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/compression/mixture_split.hpp"
#include "controller/parallel.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::testing {

struct MixtureCase {
  std::string name;
  Eigen::MatrixXd covariance;
  controller::DiscreteMeasure sources;
  int cells = 1;
  int parts = 1;
};

inline controller::MixtureCells split(const MixtureCase& mixture,
                                      const controller::Executor& run = controller::run_in_turn) {
  controller::MixtureSplitter splitter(mixture.covariance, mixture.cells, mixture.parts);
  controller::MixtureCells cells;
  splitter.split(mixture.sources.locations, mixture.sources.weights, run, cells);
  return cells;
}

/// Full, diagonal, of rank one (d > 1) and zero.
inline std::vector<Eigen::MatrixXd> covariances(Generator& generator, Eigen::Index dim) {
  const Eigen::VectorXd direction = random_matrix(generator, dim, 1);
  std::vector<Eigen::MatrixXd> all = {
      random_spd(generator, dim, 0.3),
      Eigen::MatrixXd(random_matrix(generator, dim, 1).cwiseAbs().col(0).asDiagonal()),
      Eigen::MatrixXd::Zero(dim, dim)};
  if (dim > 1) all.emplace_back(0.5 * direction * direction.transpose());
  return all;
}

/// Every dimension from one to six with every kind of covariance, few and more sources, few and
/// more cells, and limits on the parts that bind and that do not.
inline std::vector<MixtureCase> random_mixtures() {
  struct Size {
    int sources;
    int cells;
    int parts;
  };
  Generator generator(811);
  std::vector<MixtureCase> cases;
  for (int dim = 1; dim <= 6; ++dim) {
    int kind = 0;
    for (const Eigen::MatrixXd& covariance : covariances(generator, dim)) {
      for (const Size& size : {Size{1, 40, 1000}, Size{7, 1, 5}, Size{100, 101, 20},
                               Size{101, 30, 7}, Size{67, 200, 1}}) {
        cases.push_back({.name = std::to_string(dim) + " dimensions, covariance " +
                                 std::to_string(kind) + ", " + std::to_string(size.sources) +
                                 " sources, " + std::to_string(size.cells) + " cells, " +
                                 std::to_string(size.parts) + " parts",
                         .covariance = covariance,
                         .sources = random_measure(generator, dim, size.sources),
                         .cells = size.cells,
                         .parts = size.parts});
      }
      ++kind;
    }
  }
  return cases;
}

}  // namespace qsmpc::testing
