// The machines of `ssh:HOSTS`, in the syntax of GNU parallel's login lists.
#pragma once

#include <string>
#include <vector>

namespace qsmpc::harness {

struct LaunchHost {
  std::string login;  ///< [USER@]HOST for ssh; ":": this machine, without ssh
  int port = 0;       ///< 0: ssh's default
  int tasks = 1;      ///< workers there

  friend bool operator==(const LaunchHost&, const LaunchHost&) = default;
};

/// The hosts of "HOST,N/USER@HOST,N*HOST:PORT,…", or of "@FILE", a file with one host per line as
/// for GNU parallel's --sshloginfile, where # begins a comment. Throws InputError, with the key
/// "--on", on any other text, without hosts, and for more than kMostTasks workers.
[[nodiscard]] std::vector<LaunchHost> parse_hosts(const std::string& text);

}  // namespace qsmpc::harness
