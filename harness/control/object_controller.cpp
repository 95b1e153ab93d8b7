#include "harness/control/object_controller.hpp"

#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/text/printable.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kShownError = 200;  // bytes of an exception's message
constexpr double kMilliseconds = 1000.0;  // in a second

}  // namespace

Scenario with_controller(Scenario scenario, const ControllerObject& object) {
  scenario.controller.kind = kObjectController;
  scenario.controller.outside = {};
  scenario.controller.outside.command = {object.name};
  scenario.controller.outside.plans = object.plans;
  return scenario;
}

ObjectController::ObjectController(ControllerObject object, const Scenario& scenario,
                                   const models::Dynamics& dynamics)
    : object_(std::move(object)),
      patience_(answer_deadline(scenario.controller)),
      state_dim_(dynamics.state_dim()),
      decision_(scenario, dynamics) {
  if (!object_.act) throw std::invalid_argument("a controller without an act function");
}

template <class Work>
void ObjectController::guarded(const std::string& place, const Work& work) {
  const auto refuse = [&](std::string found, std::string expected) {
    throw ControllerError({.file = "controller " + object_.name,
                           .key = place,
                           .found = std::move(found),
                           .expected = std::move(expected)});
  };
  try {
    work();
  } catch (const Interrupted&) {
    throw;
  } catch (const WrongAnswer& wrong) {
    refuse(wrong.found, wrong.expected);
  } catch (const std::exception& error) {
    refuse(printable(error.what(), kShownError), "an answer");
  }
}

void ObjectController::reset(std::uint64_t seed) {
  if (object_.reset) guarded("its start", [&] { object_.reset(seed); });
}

const controller::Decision& ObjectController::decide(const controller::Situation& situation) {
  controller::check_situation(situation, state_dim_);
  const controller::Decision* decision = nullptr;
  guarded(fmt::format("period {}", situation.period), [&] {
    const auto start = std::chrono::steady_clock::now();
    ControllerAnswer answer = object_.act(situation);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    if (taken.count() > patience_) {
      throw WrongAnswer{fmt::format("an answer after {:.3g} s", taken.count()),
                        fmt::format("one within {} s (controller.deadline)", patience_)};
    }
    complete_answer(answer, decision_.shape());
    decision = &decision_.take(answer, situation, kMilliseconds * taken.count());
  });
  return *decision;
}

std::string ObjectController::log() const { return object_.log ? object_.log() : std::string(); }

}  // namespace qsmpc::harness
