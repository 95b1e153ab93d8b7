// Values as YAML that reads back as the same values.
#pragma once

#include <string>
#include <string_view>

namespace qsmpc {

/// The shortest text that reads back as the same double.
[[nodiscard]] std::string yaml_number(double value);

/// Always quoted: no text can then be taken for a number, a null or the syntax around it.
/// text: without control characters.
[[nodiscard]] std::string quoted_yaml(std::string_view text);

}  // namespace qsmpc
