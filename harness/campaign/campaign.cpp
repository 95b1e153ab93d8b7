#include "harness/campaign/campaign.hpp"

#include <stdexcept>

namespace qsmpc {

const char* trace_keeping_name(TraceKeeping keeping) {
  switch (keeping) {
    case TraceKeeping::kNone:
      return "none";
    case TraceKeeping::kFailures:
      return "failures";
    case TraceKeeping::kAll:
      return "all";
  }
  throw std::invalid_argument("trace keeping: a value that has no name");
}

}  // namespace qsmpc
