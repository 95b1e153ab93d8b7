// Reading and writing the model error, i.e. the known bounds on the difference between plant and
// model: the scenario's key `model_error`, and files with the same keys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/prediction/model_error.hpp"
#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/scenario.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

/// The keys of `model_error`, and of a file that it refers to.
[[nodiscard]] std::vector<KeyDescription> model_error_keys();

/// The context that a model error must match.
struct ModelErrorContext {
  std::string system;    ///< a name from `qsmpc list systems`
  Eigen::Index dim = 0;  ///< of its state
  std::string folder;    ///< base of relative file paths; the current folder when empty
  models::ParameterMap parameters{};  ///< of the model
  double time_step = 0.0;             ///< s, the control period
};

/// A model error and, if stated, its origin.
struct StatedModelError {
  controller::ModelError error;
  std::optional<Scenario::ErrorOrigin> origin{};
};

/// The value of `model_error` in `root`, a mapping or the path of a file that holds one; nothing
/// without the key. Problems are noted, those of the file with its name and lines; among them, an
/// error for another system, for other constants or for another control period.
[[nodiscard]] std::optional<StatedModelError> read_model_error(Section& root, Problems& problems,
                                                               const ModelErrorContext& context);

/// The keys of `stated`, one per line after `indent`; norms that are unknown in any coordinate, and
/// unknown parts of the origin, are left out.
[[nodiscard]] std::string model_error_text(const StatedModelError& stated,
                                           const std::string& indent);

/// A file that `model_error` can refer to, which reads back bit for bit: `# comment` (one line)
/// unless the comment is empty, the system, then the keys.
[[nodiscard]] std::string model_error_yaml(const StatedModelError& stated,
                                           const std::string& system,
                                           const std::string& comment = "");

}  // namespace qsmpc::harness
