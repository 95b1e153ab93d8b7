// Defensive reading of text files that users write.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace qsmpc::harness {

inline constexpr std::size_t kMaxTextFileBytes = std::size_t{1} << 20U;

/// Whether there is a regular file at `path`; false also if the system does not tell.
[[nodiscard]] bool is_file(const std::filesystem::path& path);

/// The content of a regular file. Throws InputError if there is none at `path`, if it cannot be
/// read, or if it is larger than kMaxTextFileBytes.
[[nodiscard]] std::string read_text_file(const std::string& path);

}  // namespace qsmpc::harness
