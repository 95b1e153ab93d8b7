#include "harness/cli/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace qsmpc {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputc('\n', stderr);
}

void Progress::update(int done, int total, const std::string& note) {
  if (quiet_ || total <= 0) return;
  done = std::clamp(done, 0, total);
  if (terminal_) {
    const auto now = Clock::now();
    if (drawn_ && done < total && now - last_ < kRedraw) return;
    last_ = now;
    draw_bar(done, total, note);
    return;
  }
  const int tenths = static_cast<int>(10LL * done / total);
  if (tenths <= tenths_) return;
  tenths_ = tenths;
  std::fprintf(stderr, "%s: %d of %d%s%s\n", label_.c_str(), done, total, note.empty() ? "" : ", ",
               note.c_str());
}

void Progress::draw_bar(int done, int total, const std::string& note) {
  const int filled = static_cast<int>(static_cast<long long>(kBarWidth) * done / total);
  std::string bar(static_cast<std::size_t>(filled), '#');
  bar.resize(kBarWidth, '.');
  // Back to the line's start, and clear what a longer note left.
  std::fprintf(stderr, "\r\033[K%-9s [%s] %d/%d  %s", label_.c_str(), bar.c_str(), done, total,
               note.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace qsmpc
