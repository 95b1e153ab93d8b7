// JSON as the text of a file or of a command's output.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace qsmpc::harness {

/// `json` indented by two spaces, ending in a new line. Names may come from files: bytes that are
/// not UTF-8 become U+FFFD. Numbers that are not finite are null.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

/// The same on one line, without a new line at its end.
[[nodiscard]] std::string compact_json_text(const nlohmann::ordered_json& json);

}  // namespace qsmpc::harness
