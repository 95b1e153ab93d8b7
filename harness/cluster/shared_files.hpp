// Files of a folder that several machines share, often by a network: what is atomic there, and what
// is durable when a call returns. All throw IoError with the path and the system's words.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// The content of a file; nothing where there is none. It may be half of what another machine is
/// writing at the time.
[[nodiscard]] std::optional<std::string> read_shared_file(const std::string& path);

/// Makes the file `path` with `text`, unless there is one: of all that try at the same time, on any
/// machine, one makes it. Returns whether this call did. Others may see the file before its text.
/// One that cannot be written is removed.
[[nodiscard]] bool create_shared_file(const std::string& path, const std::string& text);

/// Puts `text` in the place of the first bytes of a file, which is there and takes no more room for
/// it where it was as long before. Never makes the file.
void overwrite_shared_file(const std::string& path, const std::string& text);

/// Makes the folder `path`, unless there is something of that name. Returns whether this call did.
[[nodiscard]] bool create_shared_folder(const std::string& path);

/// Names of what is in a folder, in order.
[[nodiscard]] std::vector<std::string> names_in_folder(const std::string& folder);

}  // namespace qsmpc::harness
