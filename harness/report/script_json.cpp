#include "harness/report/script_json.hpp"

#include "harness/text/json_text.hpp"

namespace qsmpc::harness {

std::string script_json(const nlohmann::ordered_json& json) {
  const std::string text = compact_json_text(json);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else if (c == '>') {
      safe += "\\u003e";
    } else if (c == '&') {
      safe += "\\u0026";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace qsmpc::harness
