// Words for shells, and the one line of shell under which workers run.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

/// `words` as a command of sh, which splits it into these words again; csh and fish do, too, where
/// there is no new line and no '!' in it.
[[nodiscard]] std::string shell_command(const std::vector<std::string>& words);

/// The command that runs `words` as the leader of a session, its standard input empty, and exits as
/// they do (128 + N by signal N). Its own standard input is a leash: each line on it is a SIGTERM
/// to the session's processes, and its end, e.g. by the death of who holds it, ends them: SIGTERM,
/// 5 s later once more, SIGKILL 15 s later. What they leave in their process group is killed. Needs
/// sh, sleep and setsid.
[[nodiscard]] std::vector<std::string> leashed(const std::vector<std::string>& words);

}  // namespace qsmpc::harness
