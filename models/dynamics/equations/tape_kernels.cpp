// Runs a tape's program, with a loop over vectors for each instruction.
#include "models/dynamics/equations/tape_program.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/dynamics/equations/tape_kernels.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

#ifndef QSMPC_TAPE_KERNELS_ONCE
#define QSMPC_TAPE_KERNELS_ONCE

#include <algorithm>
#include <array>
#include <vector>

namespace qsmpc::models {

/// Particles processed at a time, so that their registers stay in the nearest cache.
inline constexpr std::size_t kBlock = 128;
/// From one register to the next: not a multiple of the page size, at which processors mistake
/// unrelated stores for ones that a load depends on.
inline constexpr std::size_t kRegisterStride = kBlock + 8;

}  // namespace qsmpc::models
#endif

HWY_BEFORE_NAMESPACE();
namespace qsmpc::models {
namespace HWY_NAMESPACE {

/// out[i] = function(a[i]) for `size` values, a multiple of kLanes.
template <class Function>
HWY_INLINE void map(std::size_t size, const double* a, double* out, const Function& function) {
  for (std::size_t i = 0; i < size; i += kLanes) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t at = i + part * kWidth;
      store(function(load(a + at)), out + at);
    }
  }
}
template <class Function>
HWY_INLINE void map(std::size_t size, const double* a, const double* b, double* out,
                    const Function& function) {
  for (std::size_t i = 0; i < size; i += kLanes) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t at = i + part * kWidth;
      store(function(load(a + at), load(b + at)), out + at);
    }
  }
}

HWY_INLINE Vector sign_of(Vector a) {
  const Vector below = hn::IfThenElse(hn::Lt(a, zeros()), constant(-1.0), a);
  return hn::IfThenElse(hn::Gt(a, zeros()), constant(1.0), below);
}

/// NaN stays NaN.
HWY_INLINE Vector smaller(Vector a, Vector b) {
  const Mask takes_b = hn::Or(hn::Lt(b, a), hn::IsNaN(b));
  return hn::IfThenElse(takes_b, b, a);
}
HWY_INLINE Vector larger(Vector a, Vector b) {
  const Mask takes_b = hn::Or(hn::Gt(b, a), hn::IsNaN(b));
  return hn::IfThenElse(takes_b, b, a);
}

HWY_INLINE void sines_and_cosines(std::size_t size, const double* a, double* sine, double* cosine) {
  for (std::size_t i = 0; i < size; i += kWidth) {
    const SineCosine both = sine_cosine(load(a + i));
    store(both.sine, sine + i);
    store(both.cosine, cosine + i);
  }
}

/// Arithmetic instructions only.
HWY_INLINE bool arithmetic(const TapeProgram::Instruction& step, std::size_t size, const double* a,
                           const double* b, double* out) {
  using Opcode = TapeProgram::Opcode;
  const Vector c = constant(step.constant);
  switch (step.opcode) {
    case Opcode::kNegate:
      map(size, a, out, [](Vector x) HWY_ATTR { return hn::Neg(x); });
      return true;
    case Opcode::kAdd:
      map(size, a, b, out, [](Vector x, Vector y) HWY_ATTR { return x + y; });
      return true;
    case Opcode::kSubtract:
      map(size, a, b, out, [](Vector x, Vector y) HWY_ATTR { return x - y; });
      return true;
    case Opcode::kMultiply:
      map(size, a, b, out, [](Vector x, Vector y) HWY_ATTR { return x * y; });
      return true;
    case Opcode::kDivide:
      map(size, a, b, out, [](Vector x, Vector y) HWY_ATTR { return x / y; });
      return true;
    case Opcode::kAddConstant:
      map(size, a, out, [c](Vector x) HWY_ATTR { return x + c; });
      return true;
    case Opcode::kMultiplyConstant:
      map(size, a, out, [c](Vector x) HWY_ATTR { return c * x; });
      return true;
    case Opcode::kConstantMinus:
      map(size, a, out, [c](Vector x) HWY_ATTR { return c - x; });
      return true;
    case Opcode::kDivideByConstant:
      map(size, a, out, [c](Vector x) HWY_ATTR { return x / c; });
      return true;
    case Opcode::kConstantOver:
      map(size, a, out, [c](Vector x) HWY_ATTR { return c / x; });
      return true;
    case Opcode::kAddMultiple:
      map(size, a, b, out, [c](Vector x, Vector y) HWY_ATTR { return x + c * y; });
      return true;
    case Opcode::kSquare:
      map(size, a, out, [](Vector x) HWY_ATTR { return x * x; });
      return true;
    default:
      return false;
  }
}

HWY_INLINE void function(const TapeProgram::Instruction& step, std::size_t size, const double* a,
                         const double* b, double* out, double* second) {
  using Opcode = TapeProgram::Opcode;
  switch (step.opcode) {
    case Opcode::kSqrt:
      return map(size, a, out, [](Vector x) HWY_ATTR { return hn::Sqrt(x); });
    case Opcode::kSineCosine:
      return sines_and_cosines(size, a, out, second);
    case Opcode::kSine:
      return map(size, a, out, [](Vector x) HWY_ATTR { return sine_cosine(x).sine; });
    case Opcode::kCosine:
      return map(size, a, out, [](Vector x) HWY_ATTR { return sine_cosine(x).cosine; });
    case Opcode::kAbs:
      return map(size, a, out, [](Vector x) HWY_ATTR { return hn::Abs(x); });
    case Opcode::kSign:
      return map(size, a, out, [](Vector x) HWY_ATTR { return sign_of(x); });
    case Opcode::kLessEqual:
      return map(size, a, b, out, [](Vector x, Vector y) HWY_ATTR {
        return hn::IfThenElseZero(hn::Le(x, y), constant(1.0));
      });
    case Opcode::kMin:
      return map(size, a, b, out, [](Vector x, Vector y) HWY_ATTR { return smaller(x, y); });
    case Opcode::kMax:
      return map(size, a, b, out, [](Vector x, Vector y) HWY_ATTR { return larger(x, y); });
    default:
      for (std::size_t i = 0; i < size; ++i) out[i] = evaluate(step.operation, a[i], b[i]);
  }
}

void run_block(const TapeProgram& program, std::size_t size, double* registers) {
  for (const TapeProgram::Instruction& step : program.instructions) {
    const auto at = [&](int number) HWY_ATTR {
      return registers + static_cast<std::size_t>(number) * kRegisterStride;
    };
    const double* const a = at(step.a);
    const double* const b = at(step.b);
    double* const out = at(step.target);
    if (!arithmetic(step, size, a, b, out)) {
      function(step, size, a, b, out, at(step.second_target));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::models
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::models {

HWY_EXPORT(run_block);

namespace {

/// Registers of the calling thread; they grow to the most that any program has needed.
double* scratch(std::size_t registers) {
  thread_local std::vector<double> memory;
  const std::size_t size = registers * kRegisterStride;
  if (memory.size() < size) memory.resize(size);
  return memory.data();
}

}  // namespace

void run(const TapeProgram& program, const double* const* arguments, double* const* outputs,
         std::size_t count) {
  constexpr std::size_t kWhole = 8;  // kLanes of every instruction set
  double* const registers = scratch(static_cast<std::size_t>(program.registers));
  const auto at = [&](int number) {
    return registers + static_cast<std::size_t>(number) * kRegisterStride;
  };
  for (const auto& [target, value] : program.constants) std::fill_n(at(target), kBlock, value);
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    const std::size_t whole = (size + kWhole - 1) / kWhole * kWhole;
    for (std::size_t i = 0; i < program.arguments.size(); ++i) {
      if (program.arguments[i] < 0) continue;
      double* const row = at(program.arguments[i]);
      std::copy_n(arguments[i] + begin, size, row);
      std::fill(row + size, row + whole, 0.0);
    }
    HWY_DYNAMIC_DISPATCH(run_block)(program, whole, registers);
    for (std::size_t i = 0; i < program.outputs.size(); ++i) {
      std::copy_n(at(program.outputs[i]), size, outputs[i] + begin);
    }
  }
}

}  // namespace qsmpc::models
#endif
