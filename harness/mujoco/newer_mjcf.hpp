// What an MJCF file uses that came after this program's MuJoCo, and what to write instead.
#pragma once

#include <string>

namespace qsmpc::harness {

/// The version of MuJoCo that this program is linked with, e.g. "2.2.2".
[[nodiscard]] std::string mujoco_version();

/// About `complaint`, MuJoCo's error on loading a file: where it does not know an element, an
/// attribute or a value that a later version brought, what to write instead, with both versions;
/// empty otherwise. Source of the versions: MuJoCo's changelog.
[[nodiscard]] std::string newer_mjcf_hint(const std::string& complaint);

}  // namespace qsmpc::harness
