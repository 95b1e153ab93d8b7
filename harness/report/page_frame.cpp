#include "harness/report/page_frame.hpp"

#include <fmt/format.h>

#include "harness/report/page_assets.hpp"
#include "harness/text/base64.hpp"
#include "harness/text/html.hpp"

namespace qsmpc::harness {
namespace {

std::string policy(PageScripts scripts) {
  std::string text =
      "default-src 'none'; style-src 'sha256-" + base64_of_hex(page_style_sha256()) + "'; ";
  if (scripts == PageScripts::kEpisode) {
    text += "script-src 'sha256-" + base64_of_hex(page_script_sha256()) + "'; ";
  }
  return text + "media-src 'self' file:; base-uri 'none'; form-action 'none'";
}

}  // namespace

std::string page_head(const std::string& title, PageScripts scripts) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"referrer\" content=\"no-referrer\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      policy(scripts), escape_html(title), page_style());
}

std::string page_scripts() { return fmt::format("<script>{}</script>\n", page_script()); }

std::string page_foot(const std::string& version) {
  return fmt::format("<footer>Made by qsmpc {}.</footer>\n</body>\n</html>\n",
                     escape_html(version));
}

}  // namespace qsmpc::harness
