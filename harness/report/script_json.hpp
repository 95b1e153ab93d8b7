// Data embedded in a page for its scripts.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace qsmpc::harness {

/// `json` on one line, safe inside a <script type="application/json">: nothing in it can end the
/// enclosing element.
[[nodiscard]] std::string script_json(const nlohmann::ordered_json& json);

}  // namespace qsmpc::harness
