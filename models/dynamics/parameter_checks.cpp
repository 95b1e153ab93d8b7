#include "models/dynamics/parameter_checks.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace qsmpc::models {
namespace {

[[noreturn]] void refuse(std::string_view system, std::string_view name, std::string_view range) {
  throw std::invalid_argument(std::string(system) + ": " + std::string(name) +
                              " must be a finite number " + std::string(range));
}

}  // namespace

void check_time_step(std::string_view system, double time_step) {
  if (!(std::isfinite(time_step) && time_step > 0.0)) refuse(system, "time_step", "above 0 s");
}

double positive_parameter(std::string_view system, const ParameterMap& parameters,
                          std::string_view name) {
  const auto found = parameters.find(name);
  if (found != parameters.end() && std::isfinite(found->second) && found->second > 0.0) {
    return found->second;
  }
  refuse(system, name, "above 0");
}

double non_negative_parameter(std::string_view system, const ParameterMap& parameters,
                              std::string_view name) {
  const auto found = parameters.find(name);
  if (found != parameters.end() && std::isfinite(found->second) && found->second >= 0.0) {
    return found->second;
  }
  refuse(system, name, "of at least 0");
}

double negative_parameter(std::string_view system, const ParameterMap& parameters,
                          std::string_view name) {
  const auto found = parameters.find(name);
  if (found != parameters.end() && std::isfinite(found->second) && found->second < 0.0) {
    return found->second;
  }
  refuse(system, name, "below 0");
}

}  // namespace qsmpc::models
