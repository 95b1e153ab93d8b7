// JSON as text of a file or of a command's output.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace qsmpc::harness {

/// `json` indented by two spaces, ending in a newline. Names may come from files: invalid UTF-8
/// becomes U+FFFD. Non-finite numbers become null.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

/// The same on one line, without a trailing newline.
[[nodiscard]] std::string compact_json_text(const nlohmann::ordered_json& json);

}  // namespace qsmpc::harness
