// The machines of `ssh:HOSTS`, as GNU parallel's lists of logins name them.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

struct LaunchHost {
  std::string login;  ///< [USER@]HOST for ssh; ":" is this machine, without ssh
  int port = 0;       ///< 0: ssh's own
  int tasks = 1;      ///< workers there

  friend bool operator==(const LaunchHost&, const LaunchHost&) = default;
};

/// The hosts of "HOST,N/USER@HOST,N*HOST:PORT,…", or of "@FILE", a file with one a line as of GNU
/// parallel's --sshloginfile, where # begins a comment. Throws InputError on something else, for no
/// host at all, and for more than kMostTasks workers; its key is "--on".
[[nodiscard]] std::vector<LaunchHost> parse_hosts(const std::string& text);

}  // namespace qsmpc::harness
