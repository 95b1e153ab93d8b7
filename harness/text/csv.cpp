#include "harness/text/csv.hpp"

#include <string_view>

namespace qsmpc::harness {
namespace {

// Characters that make spreadsheets evaluate a field as a formula.
constexpr std::string_view kFormulaBegins = "=+-@\t\r";

}  // namespace

std::string csv_field(const std::string& text) {
  const bool is_formula =
      !text.empty() && kFormulaBegins.find(text.front()) != std::string_view::npos;
  if (!is_formula && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = is_formula ? "\"'" : "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + "\"";
}

}  // namespace qsmpc::harness
