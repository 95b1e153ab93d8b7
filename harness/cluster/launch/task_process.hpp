// A worker as a process that this one started, here or behind ssh: it ends with its children when
// it is told to, and when this process ends.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "harness/control/descriptor.hpp"

namespace qsmpc::harness {

class TaskProcess {
 public:
  /// Starts `words`, a command with `leashed` in it, and appends what it says to the file `log`.
  /// Throws IoError.
  TaskProcess(const std::vector<std::string>& words, const std::string& log);

  /// Has SIGTERM sent to its processes.
  void ask_to_end();
  /// Has its processes ended within some seconds, as `leashed` says.
  void end() { leash_.close(); }

  /// Its exit code once it has ended; 128 + N where signal N ended it.
  [[nodiscard]] std::optional<int> exit_code();

  /// The last line that it has said; empty where there is none.
  [[nodiscard]] std::string last_words() const;

 private:
  std::string log_;
  std::int64_t log_begin_ = 0;  // bytes of it that are from before
  pid_t process_ = -1;
  Descriptor leash_;
  std::optional<int> exit_code_;
};

}  // namespace qsmpc::harness
