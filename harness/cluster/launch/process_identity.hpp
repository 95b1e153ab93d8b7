// Identifies a process for later queries by other processes and machines, when its pid may have
// been reused.
#pragma once

#include <cstdint>
#include <string>

namespace qsmpc::harness {

struct ProcessIdentity {
  std::string host{};        ///< host name of the machine
  std::string boot{};        ///< identifies the machine's boot and the pid namespace
  std::int64_t number = 0;   ///< pid
  std::int64_t started = 0;  ///< start time, in clock ticks since boot

  friend bool operator==(const ProcessIdentity&, const ProcessIdentity&) = default;
};

enum class ProcessFate { kAlive, kGone, kElsewhere };

[[nodiscard]] ProcessIdentity this_process();

/// kElsewhere if the process is on another machine, which this one cannot query.
[[nodiscard]] ProcessFate fate_of(const ProcessIdentity& process);

}  // namespace qsmpc::harness
