// A controller outside the program: a process of the user's, or one that hosts a shared library of
// the user's, queried in lines of JSON.
//
// It is started for the first drive and kept for later ones. Any failure ends it, and a new one is
// started for the next drive.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "controller/control/controller.hpp"
#include "harness/control/answered_decision.hpp"
#include "harness/control/child_process.hpp"
#include "harness/control/controller_protocol.hpp"
#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

class OutsideController final : public controller::Controller {
 public:
  /// Does not start the process yet. `dynamics` must outlive this object.
  OutsideController(const Scenario& scenario, const models::Dynamics& dynamics);
  ~OutsideController() override;

  /// Throws ControllerError on a missing answer at the deadline and on an invalid one, IoError
  /// where no process can be started, and Interrupted. In each case the process has ended.
  const controller::Decision& decide(const controller::Situation& situation) override;

  /// Starts the process if there is none. Throws as `decide`.
  using Controller::reset;
  void reset(std::uint64_t seed) override;

  [[nodiscard]] std::string log() const override;

 private:
  using Clock = ChildProcess::Clock;

  void start();
  const controller::Decision& ask(const controller::Situation& situation);
  [[nodiscard]] std::string answer_to(const std::string& message, double patience,
                                      const char* deadline_key);
  void tell(const std::string& message, double patience, const char* deadline_key);
  /// Does `work`; ends the process if that throws. place: "period 3".
  template <class Work>
  void guarded(const std::string& place, const Work& work);
  [[noreturn]] void fail(const std::string& place, const std::string& found,
                         const std::string& expected);
  void end();

  const models::Dynamics& dynamics_;
  const Scenario::Controller settings_;
  const std::string scenario_message_;
  std::unique_ptr<ChildProcess> process_;
  std::uint64_t seed_ = 0;
  bool is_reset_ = false;  // whether the process has been told of the drive
  std::string log_;        // of a process that has ended
  AnsweredDecision decision_;
};

}  // namespace qsmpc::harness
