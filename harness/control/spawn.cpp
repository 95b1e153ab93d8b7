#include "harness/control/spawn.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include "harness/control/descriptor.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

// Above the process's descriptors, so that no source is overwritten while they are set up.
constexpr int kLeastSource = 10;

/// RAII for posix_spawn's attribute and action objects.
class SpawnSettings {
 public:
  SpawnSettings() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes, &signals);
    for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD}) sigaddset(&signals, number);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  SpawnSettings(SpawnSettings&&) = delete;
  SpawnSettings& operator=(SpawnSettings&&) = delete;
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }

  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
};

[[noreturn]] void fail_to_spawn(const std::string& program) {
  throw IoError(fmt::format("{} cannot be started: {}", program, std::strerror(errno)));
}

}  // namespace

pid_t spawn_process(const std::vector<std::string>& words,
                    const std::vector<SpawnDescriptor>& descriptors) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  // The const_cast is safe: posix_spawn does not write to the arguments.
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  SpawnSettings settings;
  std::vector<Descriptor> sources;
  for (const auto& [ours, theirs] : descriptors) {
    sources.emplace_back(::fcntl(ours, F_DUPFD_CLOEXEC, kLeastSource));
    if (!sources.back().is_open()) fail_to_spawn(words.front());
    posix_spawn_file_actions_adddup2(&settings.actions, sources.back().get(), theirs);
  }
  pid_t process = -1;
  errno = ::posix_spawnp(&process, words.front().c_str(), &settings.actions, &settings.attributes,
                         arguments.data(), environ);
  if (errno != 0) fail_to_spawn(words.front());
  return process;
}

}  // namespace qsmpc::harness
