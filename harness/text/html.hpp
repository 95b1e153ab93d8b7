// Text made safe for an HTML page.
#pragma once

#include <string>
#include <string_view>

namespace qsmpc::harness {

/// `text` as character data or as a quoted attribute's value: markup characters become character
/// references; invalid UTF-8 and control characters other than tab and line feed become U+FFFD.
[[nodiscard]] std::string escape_html(std::string_view text);

/// A relative URL of the file `name` in the page's folder. Everything but letters, digits, '-',
/// '_', '.' and '~' is percent-encoded, so that the URL cannot refer to anything else.
[[nodiscard]] std::string url_beside(std::string_view name);

}  // namespace qsmpc::harness
