// The host process of a controller outside the program: it starts the controller, reports how it
// ended, and ends it with all of its children, however the program itself ends.
//
//   qsmpc-host FOLDER run PROGRAM [ARGUMENT…]
//   qsmpc-host FOLDER library LIBRARY
//
// Standard input, output and error are the controller's. Descriptor 3 is the leash, a socket to the
// program: it reports the controller's end, and when it closes, or the program ends, everything is
// ended. Started by harness/control/child_process.cpp.
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/control/host/child_end.hpp"
#include "harness/control/host/library_host.hpp"

namespace {

using qsmpc::harness::ChildEnd;

constexpr int kLeash = 3;
// Time for processes to end when asked, before they are killed.
constexpr std::chrono::milliseconds kGrace{1000};
// Processes that survive this cannot be killed, e.g. in I/O that never completes.
constexpr std::chrono::milliseconds kKilling{2000};
constexpr std::chrono::milliseconds kLook{5};

void tell(ChildEnd end) {
  // The program may have ended.
  (void)::send(kLeash, &end, sizeof end, MSG_NOSIGNAL);
}

/// Moves the protocol's descriptors away from those that a library reads and prints to.
int serve(const std::string& path) {
  const int input = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, kLeash + 1);
  const int output = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, kLeash + 1);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  ::close(nothing);
  return qsmpc::harness::serve_library(path, input, output);
}

[[noreturn]] void become_controller(const std::vector<std::string>& words, pid_t host,
                                    int failure) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != host) ::_exit(EXIT_FAILURE);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const auto give_up = [&] {
    const int error = errno;
    (void)!::write(failure, &error, sizeof error);
    ::_exit(EXIT_FAILURE);
  };
  if (::chdir(words[1].c_str()) != 0) give_up();
  if (words[2] == "library") {
    ::close(failure);
    ::close(kLeash);
    // Crashes are reported as signals, even with sanitizers.
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
      std::signal(number, SIG_DFL);
    }
    std::exit(serve(words[3]));
  }
  std::vector<char*> arguments;
  for (std::size_t i = 3; i < words.size(); ++i) {
    arguments.push_back(const_cast<char*>(words[i].c_str()));
  }
  arguments.push_back(nullptr);
  ::execvp(arguments.front(), arguments.data());
  give_up();
  std::abort();
}

/// All children, including adopted ones that have left the controller's process group.
std::vector<pid_t> children() {
  std::vector<pid_t> found;
  std::ifstream list("/proc/self/task/" + std::to_string(::getpid()) + "/children");
  for (pid_t child = 0; list >> child;) found.push_back(child);
  return found;
}

void signal_all(pid_t group, int number) {
  ::kill(-group, number);
  for (const pid_t child : children()) ::kill(child, number);
}

/// Reaps ended children and reports the controller's end. Returns whether no child is left.
bool reap(pid_t controller, bool& told) {
  for (;;) {
    int status = 0;
    const pid_t ended = ::waitpid(-1, &status, WNOHANG);
    if (ended == 0) return false;
    if (ended < 0) return errno == ECHILD;
    if (ended != controller || told) continue;
    told = true;
    const bool by_signal = WIFSIGNALED(status);
    tell({.how = by_signal ? ChildEnd::kSignal : ChildEnd::kExit,
          .value = by_signal ? WTERMSIG(status) : WEXITSTATUS(status)});
  }
}

/// Sends the signal to all; returns whether all have ended within `patience`.
bool ended_by(int number, pid_t controller, bool& told, std::chrono::milliseconds patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  signal_all(controller, number);
  while (!reap(controller, told)) {
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(kLook);
    // Orphans are adopted only once their parents have ended.
    if (number == SIGKILL) signal_all(controller, number);
  }
  return true;
}

/// Waits until the controller has ended or is no longer wanted.
void watch(pid_t controller, int signals, bool& told) {
  std::array<pollfd, 2> at{{{.fd = kLeash, .events = POLLIN, .revents = 0},
                            {.fd = signals, .events = POLLIN, .revents = 0}}};
  while (!told) {
    if (::poll(at.data(), at.size(), -1) < 0 && errno != EINTR) return;
    if (at[1].revents != 0) {
      signalfd_siginfo info;
      (void)!::read(signals, &info, sizeof info);
      reap(controller, told);
    }
    if (at[0].revents != 0) return;
  }
}

int run(const std::vector<std::string>& words) {
  ::fcntl(kLeash, F_SETFD, FD_CLOEXEC);
  // The controller must not inherit the program's other descriptors.
  ::close_range(kLeash + 1, ~0U, 0);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  std::signal(SIGPIPE, SIG_DFL);
  sigset_t child_ended;
  ::sigemptyset(&child_ended);
  ::sigaddset(&child_ended, SIGCHLD);
  ::sigprocmask(SIG_BLOCK, &child_ended, nullptr);
  const int signals = ::signalfd(-1, &child_ended, SFD_CLOEXEC);
  std::array<int, 2> failure{};
  if (signals < 0 || ::pipe2(failure.data(), O_CLOEXEC) != 0) return EXIT_FAILURE;
  const pid_t host = ::getpid();
  const pid_t controller = ::fork();
  if (controller < 0) {
    tell({.how = ChildEnd::kNoStart, .value = errno});
    return EXIT_FAILURE;
  }
  if (controller == 0) become_controller(words, host, failure[1]);
  ::setpgid(controller, controller);  // in parent and child, so that neither has to wait
  ::close(failure[1]);
  // Only the controller keeps the standard streams open, so that they close when it ends.
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::dup2(nothing, standard);
  }
  bool told = false;
  int error = 0;
  if (::read(failure[0], &error, sizeof error) == sizeof error) {
    tell({.how = ChildEnd::kNoStart, .value = error});
    told = true;
  }
  watch(controller, signals, told);
  if (!ended_by(SIGTERM, controller, told, kGrace)) {
    ended_by(SIGKILL, controller, told, kKilling);
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv, argv + argc);
  const bool is_leashed = ::fcntl(kLeash, F_GETFD) != -1;
  if (words.size() < 4 || (words[2] != "run" && words[2] != "library") || !is_leashed) {
    std::fputs("qsmpc-host is started by qsmpc to run user-defined controllers\n", stderr);
    return 2;
  }
  return run(words);
}
