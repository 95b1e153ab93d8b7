#include "tests/integration/process.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace qsmpc::testing {
namespace {

[[noreturn]] void become_qsmpc(const std::vector<std::string>& arguments,
                               const ProcessOptions& options, const std::string& out,
                               const std::string& err) {
  const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (out_file < 0 || err_file < 0 || dup2(out_file, 1) < 0 || dup2(err_file, 2) < 0) _exit(125);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(125);
  for (const std::string& name : options.unset) unsetenv(name.c_str());
  if (options.file_size_limit >= 0) {
    const auto bytes = static_cast<rlim_t>(options.file_size_limit);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit then fails with EFBIG
  }
  if (options.address_space >= 0) {
    const auto bytes = static_cast<rlim_t>(options.address_space);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = bytes};
    setrlimit(RLIMIT_AS, &limit);
  }
  std::vector<std::string> words = {QSMPC_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(QSMPC_PROGRAM, argv.data());
  _exit(126);
}

}  // namespace

ProcessResult run_qsmpc(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/out";
  const std::string err = folder.path() + "/err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become_qsmpc(arguments, options, out, err);
  int status = 0;
  bool watching = static_cast<bool>(options.meanwhile);
  while (waitpid(child, &status, watching ? WNOHANG : 0) == 0) {
    watching = !options.meanwhile(child);
    if (watching) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  ProcessResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.output = read_text(out);
  result.errors = read_text(err);
  return result;
}

std::set<std::string> files_in(const std::string& folder) {
  std::set<std::string> names;
  if (!std::filesystem::exists(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace qsmpc::testing
