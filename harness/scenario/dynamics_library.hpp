// Shared libraries of user-defined systems (models/dynamics/own_dynamics.hpp). Loading one runs its
// code with the rights of the program.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/equation_system.hpp"
#include "models/dynamics/own_dynamics_abi.h"

namespace qsmpc::harness {

class DynamicsLibrary : public std::enable_shared_from_this<DynamicsLibrary> {
 public:
  /// handle: from dlopen; closed by this object.
  DynamicsLibrary(std::string path, void* handle);
  ~DynamicsLibrary();
  DynamicsLibrary(const DynamicsLibrary&) = delete;
  DynamicsLibrary& operator=(const DynamicsLibrary&) = delete;

  /// The names of its systems.
  [[nodiscard]] std::vector<std::string> names() const;
  /// The description that the library gives of the system called `name`. Throws InputError if there
  /// is no such system, or if the description is invalid.
  [[nodiscard]] models::EquationSystem system(const std::string& name) const;
  /// The model of `system`, which is one of `system()`, possibly with other parameters. The model
  /// keeps the library loaded. Throws as models::make_own_dynamics.
  [[nodiscard]] std::unique_ptr<const models::Dynamics> make(const models::EquationSystem& system,
                                                             double time_step) const;

 private:
  [[nodiscard]] const qsmpc_system& entry(const std::string& name) const;

  std::string path_;
  void* handle_;
  const qsmpc_dynamics_table* table_;
};

/// Loads the library at the absolute path `path`; a second call returns the same library. Throws
/// InputError with the key model.library where the file is not a library, contains no systems, or
/// was built for another version.
[[nodiscard]] std::shared_ptr<const DynamicsLibrary> load_dynamics_library(const std::string& path);

}  // namespace qsmpc::harness
