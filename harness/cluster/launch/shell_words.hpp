// Shell quoting, and the shell wrapper under which workers run.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// `words` quoted as a command that sh splits into these words again; so do csh and fish if it
/// contains no newline and no '!'.
[[nodiscard]] std::string shell_command(const std::vector<std::string>& words);

/// The command that runs `words` as a session leader with empty standard input, and exits with the
/// same code (128 + N for signal N). The wrapper's own standard input is a leash: each line on it
/// sends SIGTERM to the session's process group, and its end, e.g. because its holder died, ends
/// the group: SIGTERM, a second one after 5 s, SIGKILL after 15 s. Processes left in the group when
/// the leader ends are killed. Needs sh, sleep and setsid.
[[nodiscard]] std::vector<std::string> leashed(const std::vector<std::string>& words);

}  // namespace qsmpc::harness
