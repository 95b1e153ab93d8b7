#include "harness/cli/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr int kBarWidth = 30;
constexpr std::size_t kUsualWidth = 80;  // of a terminal that does not report its width

std::size_t terminal_width() {
  winsize size{};
  const bool told = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 2;
  return told ? size.ws_col : kUsualWidth;
}

}  // namespace

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputc('\n', stderr);
}

void Progress::update(std::int64_t done, std::int64_t total, const std::string& note) {
  if (quiet_ || total <= 0) return;
  done = std::clamp(done, std::int64_t{0}, total);
  if (terminal_) {
    const auto now = Clock::now();
    if (drawn_ && done < total && now - last_ < kRedraw) return;
    last_ = now;
    draw_bar(done, total, note);
    return;
  }
  const int tenths = static_cast<int>(10 * done / total);
  if (tenths <= tenths_) return;
  tenths_ = tenths;
  // A failed write of progress is no reason to stop.
  const std::string line =
      fmt::format("{}: {} of {}{}{}\n", label_, done, total, note.empty() ? "" : ", ", note);
  std::fputs(line.c_str(), stderr);
}

void Progress::draw_bar(std::int64_t done, std::int64_t total, const std::string& note) {
  const std::int64_t filled = kBarWidth * done / total;
  std::string bar(static_cast<std::size_t>(filled), '#');
  bar.resize(kBarWidth, '.');
  const std::string line = fmt::format("{:<9} [{}] {}/{}  {}", label_, bar, done, total, note);
  // Returns to the start of the line and clears the rest of a longer note. A line that wraps could
  // not be cleared by the next one.
  std::fputs(("\r\033[K" + printable(line, terminal_width() - 2)).c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace qsmpc::harness
