#include "render/media/libav.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <stdexcept>

namespace qsmpc::render::libav {
namespace {

thread_local std::string last_complaint;

void keep_complaint(void* /*source*/, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_ERROR) {
    return;
  }
  std::array<char, 256> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  last_complaint = text.data();
  while (!last_complaint.empty() &&
         (last_complaint.back() == '\n' || last_complaint.back() == ' ')) {
    last_complaint.pop_back();
  }
}

}  // namespace

void silence_log() {
  last_complaint.clear();
  av_log_set_callback(keep_complaint);
}

int check(int code, const std::string& what) {
  if (code >= 0) {
    return code;
  }
  std::array<char, AV_ERROR_MAX_STRING_SIZE> words{};
  av_strerror(code, words.data(), words.size());
  std::string message = what + ": " + words.data();
  if (!last_complaint.empty()) {
    message += " (" + last_complaint + ")";
  }
  throw std::runtime_error(message);
}

}  // namespace qsmpc::render::libav
