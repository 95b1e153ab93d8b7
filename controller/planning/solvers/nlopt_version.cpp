#include "controller/planning/solvers/nlopt_version.hpp"

#include <nlopt.h>

namespace qsmpc::controller {

std::string nlopt_version() {
  int major = 0;
  int minor = 0;
  int bugfix = 0;
  ::nlopt_version(&major, &minor, &bugfix);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(bugfix);
}

}  // namespace qsmpc::controller
