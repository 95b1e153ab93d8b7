// MuJoCo's errors and warnings as C++ values instead of a log file, a wait for a key and exit().
//
// MuJoCo reports through two function pointers of the whole process. A MujocoTrap points them here;
// what a thread reports while its trap lives belongs to that trap:
//
//   MujocoTrap trap;
//   mj_step(model, data);                         // throws MujocoError on an error
//   for (const std::string& text : trap.warnings()) …
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// An error of MuJoCo, in its own words. The mjData that was at work must be reset before it is
/// used again: its stack is not unwound.
class MujocoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Collects this thread's warnings of MuJoCo while it lives and makes its errors exceptions. Traps
/// of one thread nest: the innermost one collects. The handlers stay installed afterwards, since
/// other threads may rely on them; without a trap an error still throws and a warning is dropped.
class MujocoTrap {
 public:
  MujocoTrap();
  ~MujocoTrap();
  MujocoTrap(const MujocoTrap&) = delete;
  MujocoTrap& operator=(const MujocoTrap&) = delete;

  /// What this thread's MuJoCo calls have warned of so far, oldest first.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static void collect(const char* text);

  std::vector<std::string> warnings_;
  MujocoTrap* outer_;
};

}  // namespace qsmpc::harness
