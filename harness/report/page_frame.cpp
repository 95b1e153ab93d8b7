#include "harness/report/page_frame.hpp"

#include <string_view>

#include <fmt/format.h>

#include "harness/report/html.hpp"
#include "harness/report/page_style.hpp"

namespace qsmpc {
namespace {

constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; media-src 'self' file:; img-src data:; "
    "base-uri 'none'; form-action 'none'";

}  // namespace

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"referrer\" content=\"no-referrer\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      kPolicy, escape_html(title), page_style());
}

std::string page_foot(const std::string& version) {
  return fmt::format("<footer>Made by qsmpc {}.</footer>\n</body>\n</html>\n",
                     escape_html(version));
}

}  // namespace qsmpc
