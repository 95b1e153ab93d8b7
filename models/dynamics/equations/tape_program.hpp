// A tape as instructions for whole batches: each register holds one value of many particles, and
// every instruction processes all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "models/dynamics/equations/tape.hpp"

namespace qsmpc::models {

struct TapeProgram {
  enum class Opcode : std::uint8_t {
    kNegate,
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kAddConstant,       ///< a + c
    kMultiplyConstant,  ///< c a
    kConstantMinus,     ///< c − a
    kDivideByConstant,  ///< a/c
    kConstantOver,      ///< c/a
    kAddMultiple,       ///< a + c b
    kSquare,
    kSqrt,
    kSineCosine,  ///< two results
    kSine,
    kCosine,
    kAbs,
    kSign,
    kLessEqual,
    kMin,
    kMax,
    kLibrary,  ///< a standard library function, value by value
  };
  struct Instruction {
    Opcode opcode{};
    Tape::Operation operation{};  ///< for kLibrary
    int target = 0;               ///< registers
    int second_target = 0;
    int a = 0;
    int b = 0;
    double constant = 0.0;
  };
  struct Constant {
    int target;
    double value;
  };

  std::vector<Constant> constants;
  std::vector<int> arguments;  ///< the register of each; -1 if it is not needed
  std::vector<Instruction> instructions;
  std::vector<int> outputs;
  int registers = 0;
};

/// The program that computes the outputs of `tape`.
[[nodiscard]] TapeProgram compile(const Tape& tape);

/// Runs `program` on `count` particles. arguments, outputs: one row of `count` values for each. An
/// output may be the row of an argument. The result for a particle does not depend on its
/// neighbours.
void run(const TapeProgram& program, const double* const* arguments, double* const* outputs,
         std::size_t count);

}  // namespace qsmpc::models
