// Text files that users write, read defensively.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace qsmpc::harness {

inline constexpr std::size_t kMaxTextFileBytes = std::size_t{1} << 20U;

/// Whether there is a regular file at `path`; not so, too, where the system does not tell.
[[nodiscard]] bool is_file(const std::filesystem::path& path);

/// The content of a regular file. Throws InputError when there is none at `path`, when it cannot be
/// read, or when it is larger than kMaxTextFileBytes.
[[nodiscard]] std::string read_text_file(const std::string& path);

}  // namespace qsmpc::harness
