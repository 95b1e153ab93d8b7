// Data of a page for its scripts.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace qsmpc::harness {

/// `json` on one line, safe inside of a <script type="application/json">: nothing in it can end the
/// element that it stands in.
[[nodiscard]] std::string script_json(const nlohmann::ordered_json& json);

}  // namespace qsmpc::harness
