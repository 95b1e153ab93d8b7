// This program's own predictions as methods: one for every propagator of the table.
#include <memory>
#include <utility>

#include "controller/laws/closed_loop_step.hpp"
#include "controller/laws/law_makers.hpp"
#include "controller/laws/law_propagator.hpp"
#include "controller/prediction/propagator.hpp"

namespace qsmpc::controller {
namespace {

class QuantisedLaw final : public LawPropagator {
 public:
  QuantisedLaw(const PropagatorEntry& entry, const LawSettings& settings)
      : entry_(entry), settings_(settings) {}

 private:
  [[nodiscard]] StageLaw begin(const LawProblem& problem) override {
    propagator_ =
        entry_.make({.noise = {.mean = Eigen::VectorXd::Zero(problem.noise_covariance.rows()),
                               .covariance = problem.noise_covariance},
                     .noise_points = settings_.noise_points,
                     .compressed_points = settings_.compressed_points});
    return quantise(problem.belief, settings_.state_points, settings_.quantiser).measure;
  }

  [[nodiscard]] StageLaw advance(const LawProblem& problem, Eigen::Index stage,
                                 const StageLaw& law) override {
    const auto& particles = std::get<DiscreteMeasure>(law);
    const Points stepped = closed_loop_step(problem, stage, particles.locations);
    propagator_->update(stepped, particles.weights, run_in_turn, map_);
    Points next(stepped.rows(), map_.clusters());
    apply_stage_map(map_, stepped, next);
    return DiscreteMeasure{.locations = std::move(next), .weights = map_.weights};
  }

  const PropagatorEntry& entry_;  // of the table
  LawSettings settings_;
  std::unique_ptr<Propagator> propagator_;
  StageMap map_;
};

}  // namespace

std::vector<LawMethod> quantised_laws() {
  std::vector<LawMethod> methods;
  for (const PropagatorEntry& entry : propagators()) {
    methods.push_back({.name = entry.name,
                       .summary = "quantised: " + entry.summary,
                       .make = [&entry](const LawSettings& settings) {
                         return std::make_unique<QuantisedLaw>(entry, settings);
                       }});
  }
  return methods;
}

}  // namespace qsmpc::controller
