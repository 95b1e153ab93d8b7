// Asks a ControllerObject, and takes its answers for what anybody may have written.
#pragma once

#include <cstdint>
#include <string>

#include "controller/control/controller.hpp"
#include "harness/control/answered_decision.hpp"
#include "harness/control/controller_object.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

class ObjectController final : public controller::Controller {
 public:
  /// `scenario` is one of with_controller. `dynamics` must outlive it. Throws
  /// std::invalid_argument where `object` cannot act.
  ObjectController(ControllerObject object, const Scenario& scenario,
                   const models::Dynamics& dynamics);

  /// Throws ControllerError on an answer that is late or wrong, and where there is none.
  const controller::Decision& decide(const controller::Situation& situation) override;

  using Controller::reset;
  /// Throws ControllerError.
  void reset(std::uint64_t seed) override;

  [[nodiscard]] std::string log() const override;

 private:
  template <class Work>
  void guarded(const std::string& place, const Work& work);

  ControllerObject object_;
  double patience_;  // s, for an answer
  Eigen::Index state_dim_;
  AnsweredDecision decision_;
};

}  // namespace qsmpc::harness
