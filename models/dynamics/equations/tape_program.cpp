#include "models/dynamics/equations/tape_program.hpp"

#include <limits>
#include <utility>

namespace qsmpc::models {
namespace {

using Operation = Tape::Operation;
using Opcode = TapeProgram::Opcode;
using Id = Tape::Id;

constexpr int kNowhere = -1;
constexpr int kForever = std::numeric_limits<int>::max();

int operand_count(Operation operation) {
  switch (operation) {
    case Operation::kArgument:
    case Operation::kConstant:
      return 0;
    case Operation::kAdd:
    case Operation::kSubtract:
    case Operation::kMultiply:
    case Operation::kDivide:
    case Operation::kLessEqual:
    case Operation::kMin:
    case Operation::kMax:
    case Operation::kAtan2:
    case Operation::kPower:
      return 2;
    default:
      return 1;
  }
}

Opcode opcode_of(Operation operation) {
  switch (operation) {
    case Operation::kNegate:
      return Opcode::kNegate;
    case Operation::kAdd:
      return Opcode::kAdd;
    case Operation::kSubtract:
      return Opcode::kSubtract;
    case Operation::kMultiply:
      return Opcode::kMultiply;
    case Operation::kDivide:
      return Opcode::kDivide;
    case Operation::kSquare:
      return Opcode::kSquare;
    case Operation::kSqrt:
      return Opcode::kSqrt;
    case Operation::kSin:
      return Opcode::kSine;
    case Operation::kCos:
      return Opcode::kCosine;
    case Operation::kAbs:
      return Opcode::kAbs;
    case Operation::kSign:
      return Opcode::kSign;
    case Operation::kLessEqual:
      return Opcode::kLessEqual;
    case Operation::kMin:
      return Opcode::kMin;
    case Operation::kMax:
      return Opcode::kMax;
    default:
      return Opcode::kLibrary;
  }
}

/// An instruction before register allocation: its operands are values of the tape.
struct Planned {
  TapeProgram::Instruction instruction;
  Id result = kNowhere;
  Id second_result = kNowhere;
  Id a = kNowhere;
  Id b = kNowhere;
};

class Compiler {
 public:
  explicit Compiler(const Tape& tape)
      : tape_(tape),
        uses_(tape.nodes().size(), 0),
        done_(tape.nodes().size(), false),
        last_use_(tape.nodes().size(), kNowhere),
        registers_(tape.nodes().size(), kNowhere) {}

  TapeProgram compile() {
    count_uses();
    for (Id id = 0; id < std::ssize(tape_.nodes()); ++id) {
      if (uses_[at(id)] > 0) plan(id);
    }
    give_registers();
    return std::move(program_);
  }

 private:
  static std::size_t at(Id id) { return static_cast<std::size_t>(id); }

  void count_uses() {
    for (const Id id : tape_.outputs) ++uses_[at(id)];
    for (Id id = static_cast<Id>(tape_.nodes().size()) - 1; id >= 0; --id) {
      const Tape::Node& node = tape_.node(id);
      if (uses_[at(id)] == 0) continue;
      const int operands = operand_count(node.operation);
      if (operands > 0) ++uses_[at(node.a)];
      if (operands > 1) ++uses_[at(node.b)];
      if (node.operation == Operation::kSin) sines_.emplace_back(node.a, id);
      if (node.operation == Operation::kCos) cosines_.emplace_back(node.a, id);
    }
  }

  void plan(Id id) {
    const Tape::Node& node = tape_.node(id);
    if (done_[at(id)] || operand_count(node.operation) == 0) return;
    done_[at(id)] = true;
    Planned planned{
        .instruction = {.opcode = opcode_of(node.operation), .operation = node.operation},
        .result = id,
        .a = node.a};
    if (operand_count(node.operation) == 2) {
      planned.b = node.b;
      take_constant(node, planned);
      if (node.operation == Operation::kAdd) take_multiple(planned);
    } else if (node.operation == Operation::kSin || node.operation == Operation::kCos) {
      take_pair(node, planned);
    }
    plan_.push_back(planned);
  }

  /// Makes constant operands part of the instruction if there is an opcode for it.
  void take_constant(const Tape::Node& node, Planned& planned) const {
    const bool first = tape_.is_constant(node.a);
    if (!first && !tape_.is_constant(node.b)) return;
    double constant = tape_.node(first ? node.a : node.b).constant;
    Opcode opcode = Opcode::kAddConstant;
    switch (node.operation) {
      case Operation::kAdd:
        break;
      case Operation::kSubtract:
        opcode = first ? Opcode::kConstantMinus : Opcode::kAddConstant;
        if (!first) constant = -constant;
        break;
      case Operation::kMultiply:
        opcode = Opcode::kMultiplyConstant;
        break;
      case Operation::kDivide:
        opcode = first ? Opcode::kConstantOver : Opcode::kDivideByConstant;
        break;
      default:
        return;
    }
    planned.instruction.opcode = opcode;
    planned.instruction.constant = constant;
    planned.a = first ? node.b : node.a;
    planned.b = kNowhere;
  }

  /// Fuses a + c b into one instruction, without the one for c b, if nothing else uses c b.
  void take_multiple(Planned& planned) {
    if (planned.instruction.opcode != Opcode::kAdd || planned.a == planned.b) return;
    for (const bool swapped : {false, true}) {
      const Id sum = swapped ? planned.b : planned.a;
      const Id product = swapped ? planned.a : planned.b;
      if (uses_[at(product)] != 1 || tape_.node(product).operation != Operation::kMultiply)
        continue;
      for (std::size_t i = plan_.size(); i-- > 0;) {
        if (plan_[i].result != product) continue;
        if (plan_[i].instruction.opcode != Opcode::kMultiplyConstant) break;
        planned.instruction.opcode = Opcode::kAddMultiple;
        planned.instruction.constant = plan_[i].instruction.constant;
        planned.a = sum;
        planned.b = plan_[i].a;
        plan_.erase(plan_.begin() + static_cast<std::ptrdiff_t>(i));
        return;
      }
    }
  }

  void take_pair(const Tape::Node& node, Planned& planned) {
    const Id sine = partner(sines_, node.a);
    const Id cosine = partner(cosines_, node.a);
    if (sine == kNowhere || cosine == kNowhere) return;
    done_[at(sine)] = true;
    done_[at(cosine)] = true;
    planned.instruction.opcode = Opcode::kSineCosine;
    planned.result = sine;
    planned.second_result = cosine;
  }

  static Id partner(const std::vector<std::pair<Id, Id>>& known, Id operand) {
    for (const auto& [of, id] : known) {
      if (of == operand) return id;
    }
    return kNowhere;
  }

  void give_registers() {
    for (std::size_t i = 0; i < plan_.size(); ++i) {
      for (const Id id : {plan_[i].a, plan_[i].b}) {
        if (id != kNowhere) last_use_[at(id)] = static_cast<int>(i);
      }
    }
    for (const Id id : tape_.outputs) last_use_[at(id)] = kForever;
    for (Id id = 0; id < std::ssize(tape_.nodes()); ++id) {
      const Tape::Node& node = tape_.node(id);
      const bool needed = last_use_[at(id)] != kNowhere;
      if (node.operation == Operation::kArgument) {
        if (needed) take_register(id);
        program_.arguments.push_back(registers_[at(id)]);
      } else if (node.operation == Operation::kConstant && needed) {
        last_use_[at(id)] = kForever;
        take_register(id);
        program_.constants.push_back({registers_[at(id)], node.constant});
      }
    }
    for (std::size_t i = 0; i < plan_.size(); ++i) emit(plan_[i], static_cast<int>(i));
    for (const Id id : tape_.outputs) program_.outputs.push_back(registers_[at(id)]);
  }

  void emit(Planned& planned, int now) {
    TapeProgram::Instruction& instruction = planned.instruction;
    instruction.a = registers_[at(planned.a)];
    if (planned.b != kNowhere) instruction.b = registers_[at(planned.b)];
    // Operands without later uses free their registers for the results.
    leave_register(planned.a, now);
    if (planned.b != kNowhere && planned.b != planned.a) leave_register(planned.b, now);
    take_register(planned.result);
    instruction.target = registers_[at(planned.result)];
    if (planned.second_result != kNowhere) {
      take_register(planned.second_result);
      instruction.second_target = registers_[at(planned.second_result)];
    }
    program_.instructions.push_back(instruction);
  }

  void take_register(Id id) {
    if (free_.empty()) free_.push_back(program_.registers++);
    registers_[at(id)] = free_.back();
    free_.pop_back();
  }

  void leave_register(Id id, int now) {
    if (last_use_[at(id)] == now) free_.push_back(registers_[at(id)]);
  }

  const Tape& tape_;
  std::vector<int> uses_;
  std::vector<bool> done_;
  std::vector<std::pair<Id, Id>> sines_;    // operand, value
  std::vector<std::pair<Id, Id>> cosines_;  // operand, value
  std::vector<Planned> plan_;
  std::vector<int> last_use_;  // by value: index of an instruction
  std::vector<int> registers_;
  std::vector<int> free_;
  TapeProgram program_;
};

}  // namespace

TapeProgram compile(const Tape& tape) { return Compiler(tape).compile(); }

}  // namespace qsmpc::models
