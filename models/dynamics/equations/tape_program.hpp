// A tape as instructions for whole batches: registers hold a value of many particles each, and
// every instruction goes through all of them.
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
    kLibrary,  ///< the standard library's, value by value
  };
  struct Instruction {
    Opcode opcode{};
    Tape::Operation operation{};  ///< of the library's
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
  std::vector<int> arguments;  ///< the register of each; -1 where it is not needed
  std::vector<Instruction> instructions;
  std::vector<int> outputs;
  int registers = 0;
};

/// The program that computes the outputs of `tape`.
[[nodiscard]] TapeProgram compile(const Tape& tape);

/// Runs `program` on `count` particles. arguments, outputs: a row of `count` values for each. An
/// output may be the row of an argument. No result depends on the particles beside it.
void run(const TapeProgram& program, const double* const* arguments, double* const* outputs,
         std::size_t count);

}  // namespace qsmpc::models
