// Queries a ControllerObject and validates its answers as untrusted input.
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
  /// `scenario` must come from with_controller. `dynamics` must outlive this object. Throws
  /// std::invalid_argument where `object` has no `act`.
  ObjectController(ControllerObject object, const Scenario& scenario,
                   const models::Dynamics& dynamics);

  /// Throws ControllerError on a late or invalid answer, and where `act` throws.
  const controller::Decision& decide(const controller::Situation& situation) override;

  using Controller::reset;
  /// Throws ControllerError.
  void reset(std::uint64_t seed) override;

  [[nodiscard]] std::string log() const override;

 private:
  template <class Work>
  void guarded(const std::string& place, const Work& work);

  ControllerObject object_;
  double patience_;  // s, time limit of an answer
  Eigen::Index state_dim_;
  AnsweredDecision decision_;
};

}  // namespace qsmpc::harness
