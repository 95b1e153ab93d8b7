// Scenario files of unsafe drives that runs of splitting found, so that `qsmpc run` drives each of
// them again alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// The file of drive `number` (from 1) that the run of `seed` found, within the campaign's folder:
/// "rare/VARIANT/SEED-NUMBER.yaml".
[[nodiscard]] std::string rare_scenario_file(std::int64_t variant, std::uint64_t seed,
                                             std::size_t number);

/// Writes the files of all drives that the store of the campaign in `folder` has. Throws IoError,
/// and what the store throws.
void write_rare_scenarios(const StoreReader& store, const std::string& folder);

}  // namespace qsmpc::harness
