// A process that other processes and machines may ask about later, when its number may be
// another's.
#pragma once

#include <cstdint>
#include <string>

namespace qsmpc::harness {

struct ProcessIdentity {
  std::string host{};        ///< name of the machine
  std::string boot{};        ///< which of its starts, and which of its spaces of process numbers
  std::int64_t number = 0;   ///< pid
  std::int64_t started = 0;  ///< clock ticks since the machine's start

  friend bool operator==(const ProcessIdentity&, const ProcessIdentity&) = default;
};

enum class ProcessFate { kAlive, kGone, kElsewhere };

[[nodiscard]] ProcessIdentity this_process();

/// kElsewhere where the process is on another machine, which this one cannot ask.
[[nodiscard]] ProcessFate fate_of(const ProcessIdentity& process);

}  // namespace qsmpc::harness
