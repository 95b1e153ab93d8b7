#include "harness/cluster/launch/task_process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/cluster/launch/command.hpp"
#include "harness/control/spawn.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::int64_t kLongestWords = 4096;  // bytes

[[noreturn]] void fail_task(const std::string& what) {
  throw IoError(fmt::format("{}: {}", what, std::strerror(errno)));
}

}  // namespace

TaskProcess::TaskProcess(const std::vector<std::string>& words, const std::string& log)
    : log_(log) {
  const Descriptor file(::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  struct stat status {};
  if (!file.is_open() || ::fstat(file.get(), &status) != 0) fail_task(log);
  log_begin_ = status.st_size;
  // Not a pipe: writing to one without a reader raises SIGPIPE.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    fail_task("socketpair");
  }
  leash_ = Descriptor(ends[0]);
  const Descriptor theirs(ends[1]);
  process_ = spawn_process(words, {{.ours = theirs.get(), .theirs = STDIN_FILENO},
                                   {.ours = file.get(), .theirs = STDOUT_FILENO},
                                   {.ours = file.get(), .theirs = STDERR_FILENO}});
}

void TaskProcess::ask_to_end() {
  constexpr std::string_view kLine = "stop\n";
  // A process that has ended needs no signal.
  if (leash_.is_open()) {
    (void)!::send(leash_.get(), kLine.data(), kLine.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
}

std::optional<int> TaskProcess::exit_code() {
  int status = 0;
  if (!exit_code_ && ::waitpid(process_, &status, WNOHANG) == process_) {
    exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    leash_.close();
  }
  return exit_code_;
}

std::string TaskProcess::last_words() const {
  const Descriptor file(::open(log_.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (!file.is_open() || ::fstat(file.get(), &status) != 0) return {};
  const std::int64_t begin = std::max(log_begin_, status.st_size - kLongestWords);
  std::array<char, kLongestWords> text{};
  const ssize_t count = ::pread(file.get(), text.data(), text.size(), begin);
  return count <= 0 ? "" : last_line({text.data(), static_cast<std::size_t>(count)});
}

}  // namespace qsmpc::harness
