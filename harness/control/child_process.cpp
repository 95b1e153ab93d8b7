#include "harness/control/child_process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/control/host_program.hpp"
#include "harness/control/spawn.hpp"
#include "harness/errors.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {
namespace {

using Clock = ChildProcess::Clock;

constexpr std::size_t kLongestLine = std::size_t{16} << 20U;  // bytes
constexpr std::size_t kLogHalf = std::size_t{128} << 10U;     // bytes
constexpr std::size_t kChunk = std::size_t{64} << 10U;        // bytes
// Longest delay in noticing a stop signal.
constexpr std::chrono::milliseconds kSlice{50};
// Time for a process to end by itself once asked.
constexpr std::chrono::milliseconds kGrace{1000};
// Time for the remaining output of an ended process to arrive.
constexpr std::chrono::milliseconds kLastWords{200};
// Time for the host to end, including the processes that it has to kill.
constexpr std::chrono::milliseconds kHostGrace{6000};
constexpr int kLeash = 3;

[[noreturn]] void fail(const char* what) {
  throw IoError(
      fmt::format("a controller's process cannot be started: {}: {}", what, std::strerror(errno)));
}

/// Both ends of a channel, inherited by no other process: the host's, and ours, which is
/// non-blocking.
struct Ends {
  Descriptor theirs;
  Descriptor ours;
};

Ends ends_of(Descriptor theirs, Descriptor ours) {
  Ends ends{.theirs = std::move(theirs), .ours = std::move(ours)};
  if (::fcntl(ends.ours.get(), F_SETFL, O_NONBLOCK) != 0) fail("fcntl");
  return ends;
}

Ends pipe_to_read() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
  return ends_of(Descriptor(ends[1]), Descriptor(ends[0]));
}

Ends pipe_to_write() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
  return ends_of(Descriptor(ends[0]), Descriptor(ends[1]));
}

Ends leash() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("socketpair");
  return ends_of(Descriptor(ends[0]), Descriptor(ends[1]));
}

/// Blocks SIGPIPE in the thread during its lifetime: a vanished reader then makes the write fail.
class NoSigpipe {
 public:
  NoSigpipe() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  NoSigpipe(const NoSigpipe&) = delete;
  NoSigpipe& operator=(const NoSigpipe&) = delete;
  ~NoSigpipe() {
    const timespec now{};
    if (sigismember(&before_, SIGPIPE) == 0) sigtimedwait(&pipe_, nullptr, &now);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_{};
  sigset_t before_{};
};

/// Passes the available data to `take`; closes the descriptor at the end of the stream.
template <class Take>
void read_some(Descriptor& from, const Take& take) {
  std::array<char, kChunk> chunk;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (;;) {
    const ssize_t count = ::read(from.get(), chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) {
      from.close();
      return;
    }
    if (!take(std::string_view(chunk.data(), static_cast<std::size_t>(count)))) return;
  }
}

std::string end_words(const ChildEnd& end) {
  switch (end.how) {
    case ChildEnd::kExit:
      return fmt::format("an exit with code {}", end.value);
    case ChildEnd::kSignal: {
      const char* const name = ::sigdescr_np(end.value);
      return fmt::format("termination by signal {} ({})", end.value,
                         name == nullptr ? "unknown" : name);
    }
    case ChildEnd::kNoStart:
      return fmt::format("a process that cannot be started: {}", std::strerror(end.value));
  }
  return {};
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& host_arguments) : log_(kLogHalf) {
  std::vector<std::string> words{host_program()};
  words.insert(words.end(), host_arguments.begin(), host_arguments.end());
  Ends input = pipe_to_write();
  Ends output = pipe_to_read();
  Ends errors = pipe_to_read();
  Ends leash = harness::leash();
  host_ = spawn_process(words, {{.ours = input.theirs.get(), .theirs = STDIN_FILENO},
                                {.ours = output.theirs.get(), .theirs = STDOUT_FILENO},
                                {.ours = errors.theirs.get(), .theirs = STDERR_FILENO},
                                {.ours = leash.theirs.get(), .theirs = kLeash}});
  input_ = std::move(input.ours);
  output_ = std::move(output.ours);
  errors_ = std::move(errors.ours);
  leash_ = std::move(leash.ours);
}

ChildProcess::~ChildProcess() { end_host(); }

bool ChildProcess::send(const std::string& line, Clock::time_point deadline) {
  to_write_ += line;
  to_write_ += '\n';
  write_some();
  while (!to_write_.empty()) {
    check_interrupts();
    if (!input_.is_open()) read_last_words();
    check_alive();
    if (Clock::now() >= deadline) return false;
    turn(deadline);
  }
  return true;
}

std::optional<std::string> ChildProcess::receive(Clock::time_point deadline) {
  for (;;) {
    check_interrupts();
    if (std::optional<std::string> line = take_line()) return line;
    if (received_.size() > kLongestLine) {
      throw ChildFailure(fmt::format("a line of more than {} bytes", kLongestLine));
    }
    if (!output_.is_open() && !end_) read_last_words();
    check_alive();
    if (Clock::now() >= deadline) return std::nullopt;
    turn(deadline);
  }
}

std::optional<std::string> ChildProcess::unasked() {
  turn(Clock::time_point::min());
  if (received_.empty()) return std::nullopt;
  return std::exchange(received_, {});
}

std::optional<std::string> ChildProcess::take_line() {
  const std::size_t end = received_.find('\n', searched_);
  searched_ = received_.size();
  if (end == std::string::npos) return std::nullopt;
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  searched_ = 0;
  return line;
}

void ChildProcess::check_alive() const {
  if (end_) throw ChildFailure(end_words(*end_));
  if (!leash_.is_open()) throw ChildFailure("the end of its supervisor process");
  if (!output_.is_open()) throw ChildFailure("its standard output closed");
}

void ChildProcess::turn(Clock::time_point until) {
  std::array<pollfd, 4> at{
      {{.fd = to_write_.empty() ? -1 : input_.get(), .events = POLLOUT, .revents = 0},
       {.fd = output_.get(), .events = POLLIN, .revents = 0},
       {.fd = errors_.get(), .events = POLLIN, .revents = 0},
       {.fd = leash_.get(), .events = POLLIN, .revents = 0}}};
  const auto now = Clock::now();
  const std::chrono::nanoseconds patience =
      until <= now ? std::chrono::nanoseconds(0)
                   : std::min<std::chrono::nanoseconds>(until - now, kSlice);
  const timespec wait{.tv_sec = 0, .tv_nsec = patience.count()};
  if (::ppoll(at.data(), at.size(), &wait, nullptr) <= 0) return;
  if (at[0].revents != 0) write_some();
  if (at[1].revents != 0) read_output();
  if (at[2].revents != 0) read_errors();
  if (at[3].revents != 0) read_leash();
}

void ChildProcess::write_some() {
  const NoSigpipe quiet;
  while (!to_write_.empty() && input_.is_open()) {
    const ssize_t count = ::write(input_.get(), to_write_.data(), to_write_.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count < 0) {
      input_.close();
      return;
    }
    to_write_.erase(0, static_cast<std::size_t>(count));
  }
}

void ChildProcess::read_output() {
  read_some(output_, [this](std::string_view text) {
    received_ += text;
    return received_.size() <= kLongestLine;
  });
}

void ChildProcess::read_errors() {
  read_some(errors_, [this](std::string_view text) {
    log_.add(text);
    return false;  // an endless writer must not hold us up
  });
}

void ChildProcess::read_leash() {
  ChildEnd end;
  const ssize_t count = ::recv(leash_.get(), &end, sizeof end, 0);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count != sizeof end) {
    leash_.close();
    return;
  }
  end_ = end;
  // All output that it wrote before it ended is available by now.
  if (output_.is_open()) read_output();
}

void ChildProcess::read_last_words() {
  const auto until = Clock::now() + kLastWords;
  while (Clock::now() < until && (errors_.is_open() || !end_) && leash_.is_open()) turn(until);
}

void ChildProcess::finish(const std::string& line) noexcept {
  try {
    to_write_ += line;
    to_write_ += '\n';
    write_some();
    input_.close();
    const auto until = Clock::now() + kGrace;
    while (!end_ && leash_.is_open() && Clock::now() < until) turn(until);
    read_last_words();
  } catch (...) {  // out of memory for the last output: the process is ended all the same
    log_.clear();
  }
}

void ChildProcess::end_host() noexcept {
  input_.close();
  if (leash_.is_open()) ::shutdown(leash_.get(), SHUT_WR);
  const auto until = Clock::now() + kHostGrace;
  std::chrono::microseconds pause{100};
  for (;;) {
    const pid_t ended = ::waitpid(host_, nullptr, WNOHANG);
    if (ended == host_ || (ended < 0 && errno != EINTR)) return;
    if (Clock::now() >= until) break;
    std::this_thread::sleep_for(pause);
    pause = std::min<std::chrono::microseconds>(2 * pause, std::chrono::milliseconds(5));
  }
  ::kill(host_, SIGKILL);  // the kernel then kills its controller too
  while (::waitpid(host_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace qsmpc::harness
