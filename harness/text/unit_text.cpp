#include "harness/text/unit_text.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace qsmpc::harness {

std::string printed_unit(std::string unit) {
  using namespace std::string_view_literals;
  constexpr std::array kPowers = {std::pair{"^2"sv, "²"sv}, std::pair{"^3"sv, "³"sv}};
  for (const auto& [plain, printed] : kPowers) {
    for (std::size_t at = unit.find(plain); at != std::string::npos; at = unit.find(plain)) {
      unit.replace(at, plain.size(), printed);
    }
  }
  return unit;
}

}  // namespace qsmpc::harness
