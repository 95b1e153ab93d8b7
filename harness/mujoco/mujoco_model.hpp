// Loading a MuJoCo model from its XML file, with errors that say where.
#pragma once

#include <memory>
#include <optional>
#include <string>

struct mjModel_;

namespace qsmpc::harness {

struct MujocoModelDeleter {
  void operator()(mjModel_* model) const;
};
/// MuJoCo's own model; its type stays opaque here.
using MujocoModelPtr = std::unique_ptr<mjModel_, MujocoModelDeleter>;

/// Loads and compiles the MJCF file `path`. Thread-safe; never null.
/// Throws InputError with file and line (where MuJoCo tells it) on a file that is missing, that is
/// no valid model, or that MuJoCo warns of.
[[nodiscard]] MujocoModelPtr load_mujoco_model(const std::string& path);

/// As load_mujoco_model, with `more`, sections of an MJCF file, after those of the file: sections
/// of one name are one, and sizes given again count. Files that the model names are found as ever.
[[nodiscard]] MujocoModelPtr load_mujoco_model_with(const std::string& path,
                                                    const std::string& more);

/// The custom text called `name` of the model, nothing where it has none.
[[nodiscard]] std::optional<std::string> custom_text(const mjModel_& model, const char* name);

/// A digest of the model that `path` compiles to, with all that it includes: the same for the same
/// model, and different for others but by chance. 16 hexadecimal digits. Throws as
/// load_mujoco_model.
[[nodiscard]] std::string mujoco_model_digest(const std::string& path);

}  // namespace qsmpc::harness
