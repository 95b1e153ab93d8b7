// Scenario files of the unsafe drives found by splitting runs, so that `qsmpc run` can reproduce
// each of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// The file, relative to the campaign's folder, of drive `number` (from 1) found by the run of
/// `seed`: "rare/VARIANT/SEED-NUMBER.yaml".
[[nodiscard]] std::string rare_scenario_file(std::int64_t variant, std::uint64_t seed,
                                             std::size_t number);

/// Writes the files of all drives in `store`, the store of the campaign in `folder`. Throws
/// IoError, and what the store throws.
void write_rare_scenarios(const StoreReader& store, const std::string& folder);

}  // namespace qsmpc::harness
