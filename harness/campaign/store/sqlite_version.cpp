#include "harness/campaign/store/sqlite_version.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

namespace qsmpc::harness {

std::string sqlite_version() { return SQLite::getLibVersion(); }

}  // namespace qsmpc::harness
