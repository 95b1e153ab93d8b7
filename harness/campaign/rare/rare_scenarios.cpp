#include "harness/campaign/rare/rare_scenarios.hpp"

#include <optional>

#include <fmt/format.h>

#include "harness/campaign/rare/rare_run.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace {

std::string rare_folder(std::int64_t variant) { return fmt::format("rare/{}", variant); }

}  // namespace

std::string rare_scenario_file(std::int64_t variant, std::uint64_t seed, std::size_t number) {
  return fmt::format("{}/{}-{}.yaml", rare_folder(variant), seed, number);
}

void write_rare_scenarios(const StoreReader& store, const std::string& folder) {
  for (const StoredVariant& variant : store.variants()) {
    std::optional<Scenario> scenario;  // parsed on first use
    store.for_each_rare(variant.id, [&](std::uint64_t seed, const RareRow& row) {
      if (row.found.empty()) return;
      if (!scenario) {
        scenario = parse_scenario(variant.scenario_text,
                                  {.file = folder + "/" + kStoreFile + ", variant " + variant.name,
                                   .folder = folder,
                                   .files_must_exist = false,
                                   .is_recorded = true});
        make_output_folder(folder + "/" + rare_folder(variant.id));
      }
      for (std::size_t n = 0; n < row.found.size(); ++n) {
        write_file(folder + "/" + rare_scenario_file(variant.id, seed, n + 1),
                   to_yaml(with_seeds(*scenario, row.found[n].seeds)));
      }
    });
  }
}

}  // namespace qsmpc::harness
