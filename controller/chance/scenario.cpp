// The scenario approach: every sampled path stays clear at every stage (Calafiore, Campi: "The
// scenario approach to robust control design", 2006; Blackmore et al. 2010).
#include "controller/chance/scenario.hpp"

#include <boost/math/distributions/binomial.hpp>

#include "controller/chance/chance_constraint.hpp"
#include "controller/chance/sampled_clearances.hpp"

namespace qsmpc::controller {
namespace {

class ScenarioConstraint final : public ChanceConstraint {
 public:
  explicit ScenarioConstraint(const ChanceProblem& problem)
      : paths_(problem.paths), clearances_(problem.unsafe, problem.horizon) {}

  [[nodiscard]] Eigen::Index per_stage() const override { return paths_; }

  void values(Eigen::Index stage, const SampledPaths& paths,
              Eigen::Ref<Eigen::VectorXd> values) override {
    values = -clearances_.look(stage, paths);
  }

  void add_adjoint(Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                   SampledPaths& paths) override {
    clearances_.subtract(stage, multipliers, paths);
  }

  [[nodiscard]] double believed(Eigen::Index stage, const SampledPaths& /*paths*/) const override {
    return clearances_.unsafe_share(stage);
  }

 private:
  Eigen::Index paths_;
  SampledClearances clearances_;
};

}  // namespace

int scenario_samples(double risk, double confidence, int decisions) {
  const auto enough = [&](int samples) {
    return boost::math::cdf(boost::math::binomial(samples, risk), decisions - 1) <=
           1.0 - confidence;
  };
  int most = decisions;
  while (!enough(most)) most *= 2;
  int least = decisions;  // fewer are never enough
  while (most - least > 1) {
    const int middle = least + (most - least) / 2;
    (enough(middle) ? most : least) = middle;
  }
  return most;
}

std::unique_ptr<ChanceConstraint> make_scenario_constraint(const ChanceProblem& problem) {
  return std::make_unique<ScenarioConstraint>(problem);
}

}  // namespace qsmpc::controller
