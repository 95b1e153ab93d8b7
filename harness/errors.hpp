// The errors that end a command, with the exit codes that the command line documents.
#pragma once

#include <stdexcept>
#include <string>

#pragma GCC visibility push(default)

namespace qsmpc::harness {

/// A wrong input: a file that does not say what it should. Exit code 2.
/// `what()` is one line: "FILE:LINE: KEY: found F, expected E". Parts not known are left out.
class InputError : public std::runtime_error {
 public:
  struct Where {
    std::string file{};
    int line = 0;       ///< from 1; 0 if a line makes no sense
    std::string key{};  ///< dotted path, e.g. "controller.quantisation.state"
    std::string found{};
    std::string expected{};
  };
  explicit InputError(Where where);
  [[nodiscard]] const Where& where() const { return where_; }

 private:
  Where where_;
};

/// A model that the simulator refuses or cannot run, with the simulator's message. An episode
/// treats it as a fault of its plant.
class SimulatorError : public InputError {
 public:
  using InputError::InputError;
};

/// An external controller that misbehaved: it ended, was late or answered wrongly. An episode
/// treats it as a fault of its controller.
class ControllerError : public InputError {
 public:
  using InputError::InputError;
};

/// A file or folder that cannot be read or written. Exit code 3.
class IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
