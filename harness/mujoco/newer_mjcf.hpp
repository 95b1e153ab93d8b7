// MJCF features newer than this program's MuJoCo, and their replacements.
#pragma once

#include <string>

namespace qsmpc::harness {

/// The version of MuJoCo that this program is linked against, e.g. "2.2.2".
[[nodiscard]] std::string mujoco_version();

/// A hint on `complaint`, MuJoCo's error on loading a file: if it rejects an element, an attribute
/// or a value that a later version introduced, the replacement to write, with both versions;
/// otherwise empty. Source of the versions: MuJoCo's changelog.
[[nodiscard]] std::string newer_mjcf_hint(const std::string& complaint);

}  // namespace qsmpc::harness
