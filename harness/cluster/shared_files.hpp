// Files in a folder that several machines share, often over a network: states what is atomic there,
// and what is durable when a call returns. All functions throw IoError with the path and the
// system's message.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace qsmpc::harness {

/// The content of a file; nothing if it does not exist. The content may be incomplete while another
/// machine is writing it.
[[nodiscard]] std::optional<std::string> read_shared_file(const std::string& path);

/// Creates the file `path` with `text` unless it exists. Of all simultaneous attempts, on any
/// machine, exactly one succeeds; returns whether this one did. Others may see the file before its
/// text. If the text cannot be written, the file is removed.
[[nodiscard]] bool create_shared_file(const std::string& path, const std::string& text);

/// Overwrites the beginning of an existing file with `text`; this needs no additional disk space if
/// the file was already as long. Never creates the file.
void overwrite_shared_file(const std::string& path, const std::string& text);

/// Creates the folder `path` unless something of that name exists. Returns whether this call did.
[[nodiscard]] bool create_shared_folder(const std::string& path);

/// The sorted names of a folder's entries.
[[nodiscard]] std::vector<std::string> names_in_folder(const std::string& folder);

}  // namespace qsmpc::harness
