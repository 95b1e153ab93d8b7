// Assets embedded in pages, from the files in web/: one style sheet, and the scripts of the
// episode's page with the libraries that they use (uPlot and three.js, pinned in
// web/package-lock.json). None refers to anything outside the page.
#pragma once

#include <string_view>

namespace qsmpc::harness {

/// The style sheet: for light and dark themes, phones and desktops, screen and print.
[[nodiscard]] std::string_view page_style();

/// The scripts, with the plotting library's licence.
[[nodiscard]] std::string_view page_script();

/// The script of the three-dimensional view, with three.js and its licence. It precedes the other
/// scripts and waits for their calls.
[[nodiscard]] std::string_view page_scene_script();

/// The SHA-256 of each as 64 hexadecimal digits, over the bytes between the opening and closing
/// <style> or <script> tags.
[[nodiscard]] std::string_view page_style_sha256();
[[nodiscard]] std::string_view page_script_sha256();
[[nodiscard]] std::string_view page_scene_script_sha256();

}  // namespace qsmpc::harness
