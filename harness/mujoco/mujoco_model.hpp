// Loading a MuJoCo model from its XML file, with errors that include file and line.
#pragma once

#include <memory>
#include <optional>
#include <string>

struct mjModel_;

namespace qsmpc::harness {

struct MujocoModelDeleter {
  void operator()(mjModel_* model) const;
};
/// MuJoCo's own model, kept opaque here.
using MujocoModelPtr = std::unique_ptr<mjModel_, MujocoModelDeleter>;

/// Loads and compiles the MJCF file `path`. Thread-safe; never null. Throws InputError with file
/// and line (where MuJoCo reports it) on a file that is missing or not a valid model, or that
/// MuJoCo warns about.
[[nodiscard]] MujocoModelPtr load_mujoco_model(const std::string& path);

/// As load_mujoco_model, with `more`, sections of an MJCF file, appended to those of the file:
/// sections of the same name are merged, and repeated sizes override earlier ones. Files that the
/// model refers to are found as usual.
[[nodiscard]] MujocoModelPtr load_mujoco_model_with(const std::string& path,
                                                    const std::string& more);

/// The custom text of the model called `name`; nothing where it has none.
[[nodiscard]] std::optional<std::string> custom_text(const mjModel_& model, const char* name);

/// A digest of the model that `path` compiles to, including all included files: equal for equal
/// models, and different for others except by chance. 16 hexadecimal digits. Throws as
/// load_mujoco_model.
[[nodiscard]] std::string mujoco_model_digest(const std::string& path);

}  // namespace qsmpc::harness
