// What pages carry with them, from the files in web/: one style sheet, and the scripts of the
// episode's page with the plotting library that they use (uPlot, pinned in web/package-lock.json).
// Neither refers to anything outside of the page.
#pragma once

#include <string_view>

namespace qsmpc::harness {

/// The style sheet: light and dark, phone and desk, screen and paper.
[[nodiscard]] std::string_view page_style();

/// The scripts, with the plotting library's licence.
[[nodiscard]] std::string_view page_script();

/// The SHA-256 of either as 64 hexadecimal digits, of the bytes between the tags <style> or
/// <script> and their ends.
[[nodiscard]] std::string_view page_style_sha256();
[[nodiscard]] std::string_view page_script_sha256();

}  // namespace qsmpc::harness
