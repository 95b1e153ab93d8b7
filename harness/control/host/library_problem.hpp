// A scenario in the form of the C interface, made from the program's message.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "controller/control/controller_abi.h"

namespace qsmpc::harness {

/// Owns all data that the problem points to.
class LibraryProblem {
 public:
  /// `scenario`: the message of type "scenario"; `line`: its text.
  LibraryProblem(const nlohmann::json& scenario, std::string line);
  LibraryProblem(const LibraryProblem&) = delete;
  LibraryProblem& operator=(const LibraryProblem&) = delete;

  [[nodiscard]] const qsmpc_problem& get() const { return problem_; }

 private:
  [[nodiscard]] const char* keep(std::string text);
  [[nodiscard]] const double* keep(std::vector<double> numbers);
  void add_system(const nlohmann::json& scenario);
  void add_surroundings(const nlohmann::json& scenario);

  std::deque<std::string> texts_;            // at stable addresses
  std::deque<std::vector<double>> numbers_;  // the same
  std::vector<qsmpc_coordinate> states_;
  std::vector<qsmpc_coordinate> inputs_;
  std::vector<const char*> parameter_names_;
  qsmpc_problem problem_{};
};

/// The numbers of a list, or of a list of rows, concatenated; null becomes `infinity`.
[[nodiscard]] std::vector<double> numbers_in(const nlohmann::json& list, double infinity);

}  // namespace qsmpc::harness
