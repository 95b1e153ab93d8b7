#include "harness/cluster/launch/command.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/cluster/launch/shell_words.hpp"
#include "harness/control/descriptor.hpp"
#include "harness/control/spawn.hpp"
#include "harness/errors.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kWordsInErrors = 160;  // bytes

struct OutputPipe {
  Descriptor ours;
  Descriptor theirs;
};

OutputPipe output_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw IoError(fmt::format("pipe: {}", std::strerror(errno)));
  }
  return {.ours = Descriptor(ends[0]), .theirs = Descriptor(ends[1])};
}

std::string command_name(const std::vector<std::string>& words) {
  return printable(shell_command(words), kWordsInErrors);
}

/// Reads the available bytes; closes the descriptor at end of file.
void read_available(Descriptor& from, std::string& text) {
  std::array<char, 4096> chunk{};
  const ssize_t count = ::read(from.get(), chunk.data(), chunk.size());
  if (count > 0) text.append(chunk.data(), static_cast<std::size_t>(count));
  if (count == 0 || (count < 0 && errno != EINTR)) from.close();
}

/// Reads both until they are closed or `until`; returns whether both were closed.
bool read_both(Descriptor& output, Descriptor& errors, CommandResult& result,
               Clock::time_point until) {
  while (output.is_open() || errors.is_open()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    if (left.count() <= 0) return false;
    std::array<pollfd, 2> at{{{.fd = output.get(), .events = POLLIN, .revents = 0},
                              {.fd = errors.get(), .events = POLLIN, .revents = 0}}};
    if (::poll(at.data(), at.size(), static_cast<int>(left.count())) <= 0) continue;
    if (at[0].revents != 0) read_available(output, result.output);
    if (at[1].revents != 0) read_available(errors, result.errors);
  }
  return true;
}

int waited_exit_code(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

CommandResult run_command(const std::vector<std::string>& words,
                          std::chrono::milliseconds patience) {
  OutputPipe output = output_pipe();
  OutputPipe errors = output_pipe();
  const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const pid_t process = spawn_process(words, {{nothing.get(), STDIN_FILENO},
                                              {output.theirs.get(), STDOUT_FILENO},
                                              {errors.theirs.get(), STDERR_FILENO}});
  output.theirs.close();
  errors.theirs.close();
  CommandResult result;
  const bool ended = read_both(output.ours, errors.ours, result, Clock::now() + patience);
  if (!ended) ::kill(-process, SIGKILL);
  result.exit_code = waited_exit_code(process);
  if (!ended) {
    throw IoError(fmt::format("{}: no answer within {} s", command_name(words),
                              std::chrono::duration_cast<std::chrono::seconds>(patience).count()));
  }
  return result;
}

std::string command_output(const std::vector<std::string>& words) {
  CommandResult result = run_command(words);
  if (result.exit_code == 0) return std::move(result.output);
  std::string said = last_line(result.errors);
  if (said.empty()) said = last_line(result.output);
  throw IoError(fmt::format("{}: exit code {}{}{}", command_name(words), result.exit_code,
                            said.empty() ? "" : ": ", said));
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return {};
  const std::size_t before = text.rfind('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return printable(text.substr(begin, end + 1 - begin), 200);
}

}  // namespace qsmpc::harness
