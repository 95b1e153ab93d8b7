#include "harness/report/page_frame.hpp"

#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "harness/report/page_assets.hpp"
#include "harness/text/base64.hpp"
#include "harness/text/html.hpp"

namespace qsmpc::harness {
namespace {

struct Script {
  std::string_view text;
  std::string_view sha256;
};

/// The scripts in execution order: that of the scene waits for calls from the other.
std::vector<Script> scripts_of(PageKind kind) {
  std::vector<Script> scripts;
  if (kind == PageKind::kEpisodeScene) {
    scripts.push_back({page_scene_script(), page_scene_script_sha256()});
  }
  if (kind == PageKind::kEpisode || kind == PageKind::kEpisodeScene) {
    scripts.push_back({page_script(), page_script_sha256()});
  }
  return scripts;
}

std::string policy(PageKind kind) {
  std::string text =
      "default-src 'none'; style-src 'sha256-" + base64_of_hex(page_style_sha256()) + "'; ";
  std::string sources;
  for (const Script& script : scripts_of(kind)) {
    sources += " 'sha256-" + base64_of_hex(script.sha256) + "'";
  }
  if (!sources.empty()) text += "script-src" + sources + "; ";
  return text + "media-src 'self' file:; base-uri 'none'; form-action 'none'";
}

std::string head(const PageFrame& frame) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"referrer\" content=\"no-referrer\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n{}\n",
      policy(frame.kind), escape_html(frame.title), page_style(),
      frame.kind == PageKind::kTables ? "<body class=\"tables\">" : "<body>");
}

}  // namespace

std::string framed_page(const PageFrame& frame, const std::string& body) {
  std::string html = head(frame) + body;
  for (const Script& script : scripts_of(frame.kind)) {
    html += fmt::format("<script>{}</script>\n", script.text);
  }
  return html + fmt::format("<footer>Made by qsmpc {}.</footer>\n</body>\n</html>\n",
                            escape_html(frame.version));
}

}  // namespace qsmpc::harness
