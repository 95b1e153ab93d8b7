#include "harness/trace/file_header.hpp"

namespace qsmpc::harness {

void write_file_header(Hdf5File& file, const FileHeader& header) {
  if (!header.kind.empty()) file.set_text("/", "kind", header.kind);
  file.set_integer("/", "schema", header.schema);
  file.set_text("/", "version", header.version);
  file.set_text("/", "scenario", header.scenario_text);
  file.set_text("/", "scenario_name", header.scenario_name);
  file.set_unsigned("/", "seed", header.seed);
}

}  // namespace qsmpc::harness
