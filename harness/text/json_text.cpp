#include "harness/text/json_text.hpp"

#include <nlohmann/json.hpp>

namespace qsmpc::harness {
namespace {

constexpr int kIndent = 2;
constexpr int kOneLine = -1;

std::string dumped(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', /*ensure_ascii=*/false,
                   nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

std::string json_text(const nlohmann::ordered_json& json) { return dumped(json, kIndent) + "\n"; }

std::string compact_json_text(const nlohmann::ordered_json& json) { return dumped(json, kOneLine); }

}  // namespace qsmpc::harness
