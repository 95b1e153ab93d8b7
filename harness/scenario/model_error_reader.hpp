// Reading and writing what is known of the difference between plant and model: the scenario's key
// `model_error`, and files of the same keys.
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

/// The keys of `model_error`, and of a file that it names.
[[nodiscard]] std::vector<KeyDescription> model_error_keys();

/// What a model error must fit.
struct ModelErrorContext {
  std::string system;    ///< a name from `qsmpc list systems`
  Eigen::Index dim = 0;  ///< of its state
  std::string folder;    ///< that the path of a file is relative to; the current one when empty
  models::ParameterMap parameters{};  ///< of the model
  double time_step = 0.0;             ///< s, the control period
};

/// A model error, and what it was measured of where that is said.
struct StatedModelError {
  controller::ModelError error;
  std::optional<Scenario::ErrorOrigin> origin{};
};

/// What `model_error` in `root` says, a mapping or the path of a file that holds one; nothing
/// without the key. Problems are noted, those of the file with its name and lines; one of them is
/// an error of another system, of other constants or of another control period.
[[nodiscard]] std::optional<StatedModelError> read_model_error(Section& root, Problems& problems,
                                                               const ModelErrorContext& context);

/// The keys of `stated`, each on a line after `indent`; norms that are unknown in any coordinate
/// are left out, and so is what is not known of the origin.
[[nodiscard]] std::string model_error_text(const StatedModelError& stated,
                                           const std::string& indent);

/// A file that `model_error` can name, of the same values bit for bit: `# comment` if there is
/// one (one line), the system, then the keys.
[[nodiscard]] std::string model_error_yaml(const StatedModelError& stated,
                                           const std::string& system,
                                           const std::string& comment = "");

}  // namespace qsmpc::harness
