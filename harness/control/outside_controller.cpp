#include "harness/control/outside_controller.hpp"

#include <chrono>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/text/printable.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kShownWords = 120;  // bytes of its standard error in a message
constexpr const char* kAnAnswer = "an answer";

ChildProcess::Clock::time_point after(double seconds) {
  return ChildProcess::Clock::now() + std::chrono::duration_cast<ChildProcess::Clock::duration>(
                                          std::chrono::duration<double>(seconds));
}

std::vector<std::string> host_arguments(const Scenario::Controller& controller) {
  const Scenario::OutsideController& outside = controller.outside;
  if (controller.kind == kLibraryController) return {"/", "library", outside.library};
  std::vector<std::string> words{outside.folder, "run"};
  words.insert(words.end(), outside.command.begin(), outside.command.end());
  return words;
}

}  // namespace

OutsideController::OutsideController(const Scenario& scenario, const models::Dynamics& dynamics)
    : dynamics_(dynamics),
      settings_(scenario.controller),
      scenario_message_(scenario_message(scenario, dynamics.description())),
      decision_(scenario, dynamics) {}

OutsideController::~OutsideController() {
  if (process_ != nullptr) process_->finish(end_message());
}

void OutsideController::reset(std::uint64_t seed) {
  seed_ = seed;
  is_reset_ = false;
  log_.clear();
  if (process_ != nullptr) {
    // Output, or an end, after the last answer of a drive does not belong to the next one.
    if (process_->unasked() || !process_->is_alive()) process_.reset();
  }
  if (process_ != nullptr) process_->log().clear();
  guarded("its start", [&] { start(); });
}

const controller::Decision& OutsideController::decide(const controller::Situation& situation) {
  controller::check_situation(situation, dynamics_.state_dim());
  const controller::Decision* decision = nullptr;
  guarded(fmt::format("period {}", situation.period), [&] {
    if (process_ == nullptr || !is_reset_) start();
    decision = &ask(situation);
  });
  return *decision;
}

template <class Work>
void OutsideController::guarded(const std::string& place, const Work& work) {
  try {
    work();
  } catch (const WrongAnswer& wrong) {
    fail(place, wrong.found, wrong.expected);
  } catch (const ChildFailure& failure) {
    process_->read_last_words();
    const std::string words = process_->log().last_line();
    const std::string found = failure.what();
    fail(place, words.empty() ? found : found + " after \"" + printable(words, kShownWords) + "\"",
         kAnAnswer);
  } catch (...) {
    end();
    throw;
  }
}

void OutsideController::fail(const std::string& place, const std::string& found,
                             const std::string& expected) {
  end();
  throw ControllerError({.file = "controller " + outside_controller_name(settings_),
                         .key = place,
                         .found = found,
                         .expected = expected});
}

std::string OutsideController::log() const {
  if (process_ == nullptr) return log_;
  process_->listen();
  return process_->log().text();
}

void OutsideController::end() {
  if (process_ == nullptr) return;
  log_ = process_->log().text();
  process_.reset();
}

void OutsideController::tell(const std::string& message, double patience,
                             const char* deadline_key) {
  if (process_->send(message, after(patience))) return;
  throw ChildFailure(fmt::format("no input read for {} s (controller.{})", patience, deadline_key));
}

std::string OutsideController::answer_to(const std::string& message, double patience,
                                         const char* deadline_key) {
  const auto deadline = after(patience);
  tell(message, patience, deadline_key);
  std::optional<std::string> line = process_->receive(deadline);
  if (line) return *std::move(line);
  throw ChildFailure(fmt::format("no answer within {} s (controller.{})", patience, deadline_key));
}

void OutsideController::start() {
  const double patience = settings_.outside.start_deadline;
  if (process_ == nullptr) {
    process_ = std::make_unique<ChildProcess>(host_arguments(settings_));
    check_greeting(answer_to(scenario_message_, patience, "start_deadline"));
  }
  tell(reset_message(seed_), patience, "start_deadline");
  is_reset_ = true;
}

const controller::Decision& OutsideController::ask(const controller::Situation& situation) {
  const auto start = Clock::now();
  if (const std::optional<std::string> unasked = process_->unasked()) {
    throw WrongAnswer{"an unrequested answer: " + printable(*unasked), "one answer per period"};
  }
  const double patience = answer_deadline(settings_);
  const std::string line = answer_to(situation_message(situation, patience), patience, "deadline");
  const ControllerAnswer answer = read_answer(line, situation.period, decision_.shape());
  const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
  return decision_.take(answer, situation, taken.count());
}

}  // namespace qsmpc::harness
