// What pages carry with them, from the files in web/: one style sheet, and the scripts of the
// episode's page with the libraries that they use (uPlot and three.js, pinned in
// web/package-lock.json). None refers to anything outside of the page.
#pragma once

#include <string_view>

namespace qsmpc::harness {

/// The style sheet: light and dark, phone and desk, screen and paper.
[[nodiscard]] std::string_view page_style();

/// The scripts, with the plotting library's licence.
[[nodiscard]] std::string_view page_script();

/// The script of the view in three dimensions, with three.js and its licence. It waits for what
/// the other scripts tell it, and stands before them.
[[nodiscard]] std::string_view page_scene_script();

/// The SHA-256 of each as 64 hexadecimal digits, of the bytes between the tags <style> or
/// <script> and their ends.
[[nodiscard]] std::string_view page_style_sha256();
[[nodiscard]] std::string_view page_script_sha256();
[[nodiscard]] std::string_view page_scene_script_sha256();

}  // namespace qsmpc::harness
