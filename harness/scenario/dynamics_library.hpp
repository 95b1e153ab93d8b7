// Shared libraries with systems of a user's (models/dynamics/own_dynamics.hpp). Loading one runs
// its code with the rights of the program.
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
  /// handle: of dlopen, which this closes.
  DynamicsLibrary(std::string path, void* handle);
  ~DynamicsLibrary();
  DynamicsLibrary(const DynamicsLibrary&) = delete;
  DynamicsLibrary& operator=(const DynamicsLibrary&) = delete;

  /// The names of its systems.
  [[nodiscard]] std::vector<std::string> names() const;
  /// What the system called `name` says of itself. Throws InputError if there is none, or where
  /// what it says cannot be.
  [[nodiscard]] models::EquationSystem system(const std::string& name) const;
  /// The model of `system`, one of `system()` with other parameters; it keeps the library. Throws
  /// as models::make_own_dynamics.
  [[nodiscard]] std::unique_ptr<const models::Dynamics> make(const models::EquationSystem& system,
                                                             double time_step) const;

 private:
  [[nodiscard]] const qsmpc_system& entry(const std::string& name) const;

  std::string path_;
  void* handle_;
  const qsmpc_dynamics_table* table_;
};

/// Loads the library at the absolute path `path`; a second time it is the same. Throws InputError
/// with the key model.library where it is no library, is none with systems, or was made for another
/// version.
[[nodiscard]] std::shared_ptr<const DynamicsLibrary> load_dynamics_library(const std::string& path);

}  // namespace qsmpc::harness
