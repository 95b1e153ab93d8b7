// A worker process started by this one, locally or through ssh. It ends, with its children, on
// request and when this process ends.
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
  /// Starts `words`, a command that contains `leashed`, and appends its output to the file `log`.
  /// Throws IoError.
  TaskProcess(const std::vector<std::string>& words, const std::string& log);

  /// Requests SIGTERM for its processes.
  void ask_to_end();
  /// Ends its processes within some seconds, as described at `leashed`.
  void end() { leash_.close(); }

  /// Its exit code once it has ended; 128 + N if signal N ended it.
  [[nodiscard]] std::optional<int> exit_code();

  /// Its last line of output; empty if there is none.
  [[nodiscard]] std::string last_words() const;

 private:
  std::string log_;
  std::int64_t log_begin_ = 0;  // size of the log at the start, bytes
  pid_t process_ = -1;
  Descriptor leash_;
  std::optional<int> exit_code_;
};

}  // namespace qsmpc::harness
