// Waits for other processes and inspects what they leave behind.
#pragma once

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

namespace qsmpc::testing {

/// Whether `condition` became true within a time limit far longer than any run needs.
template <class Condition>
bool soon(const Condition& condition, int seconds = 30) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// The whole content of a file; empty if it does not exist.
inline std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The first word of a file.
inline std::string word_of(const std::string& path) {
  std::string word;
  std::ifstream(path) >> word;
  return word;
}

/// Whether process `number` exists and has not ended.
inline bool is_process(const std::string& number) {
  const std::string status = text_of("/proc/" + number + "/stat");
  const std::size_t name_end = status.rfind(')');
  return name_end != std::string::npos && status.substr(name_end + 2, 1) != "Z";
}

}  // namespace qsmpc::testing
