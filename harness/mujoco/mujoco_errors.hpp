// MuJoCo's errors and warnings as C++ values, instead of a log file, a wait for a key and exit().
//
// MuJoCo reports through two process-wide function pointers. A MujocoTrap redirects them here;
// reports of a thread belong to the trap that is alive in that thread:
//
//   MujocoTrap trap;
//   mj_step(model, data);                         // throws MujocoError on an error
//   for (const std::string& text : trap.warnings()) …
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// An error of MuJoCo, in its own words. The mjData in use must be reset before it is used again,
/// since its stack is not unwound.
class MujocoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// During its lifetime, collects this thread's MuJoCo warnings and turns its errors into
/// exceptions. Traps of one thread nest: the innermost one collects. The handlers remain installed
/// afterwards, since other threads may rely on them; without a trap, an error still throws and a
/// warning is dropped.
class MujocoTrap {
 public:
  MujocoTrap();
  ~MujocoTrap();
  MujocoTrap(const MujocoTrap&) = delete;
  MujocoTrap& operator=(const MujocoTrap&) = delete;

  /// The warnings of this thread's MuJoCo calls so far, oldest first.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static void collect(const char* text);

  std::vector<std::string> warnings_;
  MujocoTrap* outer_;
};

}  // namespace qsmpc::harness
