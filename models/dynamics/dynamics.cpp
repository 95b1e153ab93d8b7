#include "models/dynamics/dynamics.hpp"

#include <algorithm>
#include <stdexcept>

#include "models/constants.hpp"
#include "models/dynamics/bicycle.hpp"
#include "models/dynamics/cart_pole.hpp"
#include "models/dynamics/double_integrator.hpp"
#include "models/dynamics/dubins.hpp"
#include "models/dynamics/dubins_rk4.hpp"
#include "models/dynamics/point_mass.hpp"

namespace qsmpc::models {
namespace {

using Factory = std::unique_ptr<const Dynamics> (*)(const ParameterMap&, double);

struct Registration {
  SystemEntry entry;
  Factory make;
};

const std::vector<Registration>& registrations() {
  static const std::vector<Registration> table = {
      {dubins_entry(), make_dubins},       {dubins_rk4_entry(), make_dubins_rk4},
      {bicycle_entry(), make_bicycle},     {double_integrator_entry(), make_double_integrator},
      {cart_pole_entry(), make_cart_pole}, {point_mass_entry(), make_point_mass},
  };
  return table;
}

std::string joined_names(const ParameterMap& parameters) {
  std::string names;
  for (const auto& [name, value] : parameters) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : names;
}

}  // namespace

int SystemDescription::state_index(std::string_view wanted) const {
  const auto found = std::find_if(states.begin(), states.end(),
                                  [&](const Coordinate& state) { return state.name == wanted; });
  return found == states.end() ? -1 : static_cast<int>(found - states.begin());
}

DerivativeBounds unknown_derivative_bounds(int state_dim, int input_dim) {
  const int arguments = state_dim + input_dim;
  const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Constant(state_dim, arguments, kInfinity);
  const std::vector<Eigen::MatrixXd> hessian(
      state_dim, Eigen::MatrixXd::Constant(arguments, arguments, kInfinity));
  DerivativeBounds bounds{-jacobian, jacobian, hessian, hessian};
  for (Eigen::MatrixXd& matrix : bounds.hessian_lower) matrix = -matrix;
  return bounds;
}

void check_box(const SystemDescription& system, const Eigen::Ref<const Eigen::VectorXd>& lower,
               const Eigen::Ref<const Eigen::VectorXd>& upper) {
  const Eigen::Index arguments = std::ssize(system.states) + std::ssize(system.inputs);
  if (lower.size() != arguments || upper.size() != arguments) {
    throw std::invalid_argument(system.name + ": a box must bound every state and input");
  }
  if (!(lower.array() <= upper.array()).all() || !(lower.array() < kInfinity).all() ||
      !(upper.array() > -kInfinity).all()) {
    throw std::invalid_argument(system.name + ": a box must have lower ≤ upper");
  }
}

DerivativeBounds Dynamics::derivative_bounds(
    const Eigen::Ref<const Eigen::VectorXd>& /*lower*/,
    const Eigen::Ref<const Eigen::VectorXd>& /*upper*/) const {
  return unknown_derivative_bounds(state_dim(), input_dim());
}

const std::vector<SystemEntry>& systems() {
  static const std::vector<SystemEntry> entries = [] {
    std::vector<SystemEntry> all;
    for (const Registration& registration : registrations()) all.push_back(registration.entry);
    return all;
  }();
  return entries;
}

std::unique_ptr<const Dynamics> make_dynamics(std::string_view name, const ParameterMap& parameters,
                                              double time_step) {
  for (const auto& [entry, make] : registrations()) {
    if (entry.name != name) continue;
    ParameterMap complete = entry.defaults;
    for (const auto& [key, value] : parameters) {
      const auto known = complete.find(key);
      if (known == complete.end()) {
        throw std::invalid_argument(entry.name + " has no parameter '" + key +
                                    "'; it has: " + joined_names(entry.defaults));
      }
      known->second = value;
    }
    return make(complete, time_step);
  }
  std::string known;
  for (const SystemEntry& entry : systems()) known += (known.empty() ? "" : ", ") + entry.name;
  throw std::invalid_argument("no system '" + std::string(name) + "'; known: " + known);
}

}  // namespace qsmpc::models
