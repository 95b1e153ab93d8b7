#include "models/dynamics/equations/equation_tape.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "models/dynamics/equations/expression.hpp"

namespace qsmpc::models {
namespace {

using Id = Tape::Id;
using Operation = Tape::Operation;

constexpr const char* kStates = "states";
constexpr const char* kInputs = "inputs";
constexpr const char* kParameters = "parameters";
constexpr const char* kDefine = "define";
constexpr const char* kEquations = "equations";

struct ParsedFormula {
  const char* section;
  std::string name;
  Expression expression;
};

std::string at_column(const std::string& found, std::size_t column) {
  return column > 0 ? found + " in column " + std::to_string(column) : found;
}

ParsedFormula parsed(const char* section, const EquationSystem::Formula& formula) {
  try {
    return {section, formula.name, parse_expression(formula.text)};
  } catch (const ExpressionError& error) {
    throw EquationError({.section = section,
                         .name = formula.name,
                         .found = at_column(error.found(), error.column()),
                         .expected = error.expected(),
                         .unknown = error.unknown(),
                         .known = error.known()});
  }
}

std::optional<Operation> operation_of(const std::string& function) {
  static const std::map<std::string, Operation> operations = {
      {"abs", Operation::kAbs},   {"acos", Operation::kAcos},   {"asin", Operation::kAsin},
      {"atan", Operation::kAtan}, {"cos", Operation::kCos},     {"cosh", Operation::kCosh},
      {"exp", Operation::kExp},   {"log", Operation::kLog},     {"sin", Operation::kSin},
      {"sinh", Operation::kSinh}, {"sqrt", Operation::kSqrt},   {"tan", Operation::kTan},
      {"tanh", Operation::kTanh}, {"atan2", Operation::kAtan2}, {"max", Operation::kMax},
      {"min", Operation::kMin},
  };
  const auto found = operations.find(function);
  return found == operations.end() ? std::nullopt : std::optional(found->second);
}

class TapeMaker {
 public:
  TapeMaker(const EquationSystem& system, double time_step)
      : system_(system),
        time_step_(time_step),
        tape_(static_cast<int>(system.states.size() + system.inputs.size())) {}

  Tape make() {
    check_names();
    parse();
    const std::size_t dim = system_.states.size();
    std::vector<Id> state(dim);
    for (std::size_t i = 0; i < dim; ++i) state[i] = tape_.argument(static_cast<int>(i));
    if (system_.time == EquationSystem::Time::kDiscrete) {
      state = formulas_at(state);
    } else {
      for (int step = 0; step < system_.substeps; ++step) state = integrated(state);
    }
    tape_.outputs = state;
    return std::move(tape_);
  }

 private:
  void check_names() {
    std::map<std::string, std::string> taken{{kPiName, "the constant pi"},
                                             {kTimeStepName, "the control period"}};
    for (const ExpressionFunction& function : expression_functions()) {
      taken.emplace(function.name, "a function");
    }
    const auto claim = [&](const char* section, const std::string& name, const char* what) {
      if (!is_expression_name(name)) {
        throw EquationError({.section = section,
                             .name = name,
                             .found = "the name '" + name + "'",
                             .expected = "a letter, then letters, digits and _"});
      }
      const auto [place, is_new] = taken.emplace(name, what);
      if (is_new) return;
      throw EquationError({.section = section,
                           .name = name,
                           .found = "the name '" + name + "', which is " + place->second,
                           .expected = "another name"});
    };
    for (const Coordinate& state : system_.states) claim(kStates, state.name, "a state");
    for (const Coordinate& input : system_.inputs) claim(kInputs, input.name, "an input");
    for (const auto& parameter : system_.parameters) {
      claim(kParameters, parameter.name, "a parameter");
    }
    for (const auto& definition : system_.definitions) {
      claim(kDefine, definition.name, "a definition");
    }
    for (auto& [name, what] : taken) {
      if (what != "a function") names_.push_back(name);
    }
  }

  void parse() {
    std::vector<std::string> states;
    for (const Coordinate& state : system_.states) states.push_back(state.name);
    for (const EquationSystem::Formula& equation : system_.equations) {
      if (std::ranges::find(states, equation.name) != states.end()) continue;
      throw EquationError({.section = kEquations,
                           .name = equation.name,
                           .found = "an equation for '" + equation.name + "'",
                           .unknown = equation.name,
                           .known = states});
    }
    for (const std::string& state : states) {
      const auto equation =
          std::ranges::find(system_.equations, state, &EquationSystem::Formula::name);
      if (equation == system_.equations.end()) {
        throw EquationError({.section = kEquations,
                             .name = state,
                             .found = "nothing",
                             .expected = "an equation for this state"});
      }
      equations_.push_back(parsed(kEquations, *equation));
    }
    for (const EquationSystem::Formula& definition : system_.definitions) {
      definitions_.emplace(definition.name, parsed(kDefine, definition));
    }
    // Definitions that no equation uses are checked as well.
    (void)formulas_at(arguments_from(0, system_.states.size()));
    for (const auto& [name, definition] : definitions_) (void)defined(definition);
  }

  std::vector<Id> arguments_from(std::size_t first, std::size_t count) {
    std::vector<Id> ids;
    for (std::size_t i = 0; i < count; ++i) {
      ids.push_back(tape_.argument(static_cast<int>(first + i)));
    }
    return ids;
  }

  /// The equations evaluated at the states `state`.
  std::vector<Id> formulas_at(const std::vector<Id>& state) {
    values_ = {{kPiName, tape_.constant(std::numbers::pi)},
               {kTimeStepName, tape_.constant(time_step_)}};
    const std::vector<Id> inputs = arguments_from(state.size(), system_.inputs.size());
    for (std::size_t i = 0; i < state.size(); ++i) values_[system_.states[i].name] = state[i];
    for (std::size_t i = 0; i < inputs.size(); ++i) values_[system_.inputs[i].name] = inputs[i];
    for (const auto& parameter : system_.parameters) {
      values_[parameter.name] = tape_.constant(parameter.value);
    }
    std::vector<Id> results;
    for (const ParsedFormula& equation : equations_) results.push_back(evaluated(equation));
    return results;
  }

  /// The states one step of the integrator after `state`; in the order of runge_kutta_step.
  std::vector<Id> integrated(const std::vector<Id>& state) {
    const double step = time_step_ / system_.substeps;
    const auto moved = [&](double by, const std::vector<Id>& slope) {
      std::vector<Id> result;
      for (std::size_t i = 0; i < state.size(); ++i) {
        result.push_back(tape_.add(state[i], tape_.multiply(tape_.constant(by), slope[i])));
      }
      return result;
    };
    const std::vector<Id> first = formulas_at(state);
    if (system_.time == EquationSystem::Time::kEuler) return moved(step, first);
    const std::vector<Id> second = formulas_at(moved(0.5 * step, first));
    const std::vector<Id> third = formulas_at(moved(0.5 * step, second));
    const std::vector<Id> fourth = formulas_at(moved(step, third));
    std::vector<Id> mean;
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Id middle = tape_.multiply(tape_.constant(2.0), tape_.add(second[i], third[i]));
      mean.push_back(tape_.add(tape_.add(first[i], middle), fourth[i]));
    }
    return moved(step / 6.0, mean);
  }

  Id defined(const ParsedFormula& definition) {
    const auto known = values_.find(definition.name);
    if (known != values_.end()) return known->second;
    if (std::ranges::find(open_, definition.name) != open_.end()) {
      std::string circle;
      for (const std::string& name : open_) circle += name + ", ";
      throw EquationError({.section = kDefine,
                           .name = definition.name,
                           .found = "a circular definition: " + circle + definition.name,
                           .expected = "definitions without circular references"});
    }
    open_.push_back(definition.name);
    const Id value = evaluated(definition);
    open_.pop_back();
    return values_[definition.name] = value;
  }

  Id value_of(const ParsedFormula& formula, const Expression::Step& step) {
    const auto value = values_.find(step.name);
    if (value != values_.end()) return value->second;
    const auto definition = definitions_.find(step.name);
    if (definition != definitions_.end()) return defined(definition->second);
    throw EquationError({.section = formula.section,
                         .name = formula.name,
                         .found = at_column("the name '" + step.name + "'", step.column),
                         .unknown = step.name,
                         .known = names_});
  }

  Id evaluated(const ParsedFormula& formula) {
    using Kind = Expression::Kind;
    std::vector<Id> stack;
    const auto pop = [&stack] {
      const Id top = stack.back();
      stack.pop_back();
      return top;
    };
    for (const Expression::Step& step : formula.expression.steps) {
      if (step.kind == Kind::kNumber) {
        stack.push_back(tape_.constant(step.number));
      } else if (step.kind == Kind::kName) {
        stack.push_back(value_of(formula, step));
      } else if (step.kind == Kind::kNegate) {
        stack.push_back(tape_.negate(pop()));
      } else if (step.kind == Kind::kCall && step.name != "pow") {
        const Operation operation = operation_of(step.name).value();
        const bool is_binary = operation == Operation::kAtan2 || operation == Operation::kMin ||
                               operation == Operation::kMax;
        const Id last = pop();
        stack.push_back(is_binary ? tape_.binary(operation, pop(), last)
                                  : tape_.unary(operation, last));
      } else {
        const Id second = pop();
        const Id first = pop();
        stack.push_back(combined(step.kind, first, second));
      }
    }
    return stack.back();
  }

  Id combined(Expression::Kind kind, Id first, Id second) {
    switch (kind) {
      case Expression::Kind::kAdd:
        return tape_.add(first, second);
      case Expression::Kind::kSubtract:
        return tape_.subtract(first, second);
      case Expression::Kind::kMultiply:
        return tape_.multiply(first, second);
      case Expression::Kind::kDivide:
        return tape_.divide(first, second);
      default:
        return tape_.power(first, second);
    }
  }

  const EquationSystem& system_;
  double time_step_;
  Tape tape_;
  std::vector<std::string> names_;  // that formulas may use
  std::vector<ParsedFormula> equations_;
  std::map<std::string, ParsedFormula> definitions_;
  std::map<std::string, Id> values_;  // at the current states
  std::vector<std::string> open_;     // definitions that are being evaluated
};

}  // namespace

Tape step_tape(const EquationSystem& system, double time_step) {
  return TapeMaker(system, time_step).make();
}

}  // namespace qsmpc::models
