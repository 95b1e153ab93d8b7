// Campaigns: planning, driving, and their stores as arrays.
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "harness/campaign/plan/campaign_file.hpp"
#include "harness/campaign/plan/campaign_plan.hpp"
#include "harness/campaign/runner.hpp"
#include "harness/campaign/statistics/campaign_json.hpp"
#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/status.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/cli/campaign_results.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"
#include "harness/threads/interruption.hpp"
#include "harness/threads/workers.hpp"
#include "models/constants.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;

/// The columns of a table, by name: numbers, integers and texts.
struct Columns {
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::vector<std::int64_t>> whole;
  std::map<std::string, std::vector<std::string>> texts;
};

double or_nan(const std::optional<double>& value) { return value.value_or(kNotANumber); }

void add_row(const harness::EpisodeRow& row, Columns& columns) {
  auto& [numbers, whole, texts] = columns;
  whole["variant"].push_back(row.variant);
  whole["seed"].push_back(static_cast<std::int64_t>(row.seed));
  texts["outcome"].push_back(row.outcome);
  whole["steps"].push_back(row.steps);
  numbers["time_to_target"].push_back(or_nan(row.time_to_target));
  whole["unsafe"].push_back(row.unsafe ? 1 : 0);
  numbers["min_clearance"].push_back(row.min_clearance);
  numbers["cost"].push_back(row.cost);
  numbers["next_step_max"].push_back(row.next_step_max);
  numbers["next_step_sum"].push_back(row.next_step_sum);
  numbers["believed_max"].push_back(or_nan(row.believed_max));
  numbers["believed_sum"].push_back(or_nan(row.believed_sum));
  numbers["horizon_max"].push_back(row.horizon_max);
  numbers["iterations_median"].push_back(row.iterations_median);
  whole["fallbacks"].push_back(row.fallbacks);
  whole["risk_exceeded"].push_back(row.risk_exceeded.value_or(-1));
  whole["deadline_misses"].push_back(row.timing.deadline_misses);
  numbers["wall_ms"].push_back(row.timing.wall_ms);
  texts["trace"].push_back(row.trace);
}

nb::dict as_arrays(Columns columns) {
  const nb::object numpy = nb::module_::import_("numpy");
  nb::dict arrays;
  for (auto& [name, values] : columns.numbers) {
    const std::size_t size = values.size();
    arrays[name.c_str()] = array_of(std::move(values), {size});
  }
  for (auto& [name, values] : columns.whole) {
    const std::size_t size = values.size();
    arrays[name.c_str()] = array_of(std::move(values), {size});
  }
  for (auto& [name, values] : columns.texts) {
    arrays[name.c_str()] = numpy.attr("asarray")(nb::cast(values), numpy.attr("str_"));
  }
  return arrays;
}

/// A campaign's store. Each call sees the store's current state.
class Store {
 public:
  explicit Store(std::string folder) : folder_(std::move(folder)) { (void)reader(); }

  [[nodiscard]] const std::string& folder() const { return folder_; }

  [[nodiscard]] std::vector<std::map<std::string, std::string>> variants() const {
    std::vector<std::map<std::string, std::string>> list;
    const harness::StoreReader store = reader();
    for (const harness::StoredVariant& variant : store.variants()) {
      list.push_back({{"name", variant.name},
                      {"scenario", variant.scenario},
                      {"settings", variant.settings},
                      {"plant", variant.plant},
                      {"scenario_text", variant.scenario_text}});
    }
    return list;
  }

  [[nodiscard]] nb::dict episodes() const {
    Columns columns = without_lock([&] {
      const harness::StoreReader store = reader();
      Columns read;
      for (const harness::StoredVariant& variant : store.variants()) {
        store.for_each_episode(variant.id,
                               [&](const harness::EpisodeRow& row) { add_row(row, read); });
      }
      return read;
    });
    return as_arrays(std::move(columns));
  }

  [[nodiscard]] nb::dict periods(std::int64_t variant) const {
    Columns columns = without_lock([&] {
      Columns read;
      reader().for_each_period(
          variant, [&](std::uint64_t seed, std::int64_t period, const harness::PeriodRow& row) {
            read.whole["seed"].push_back(static_cast<std::int64_t>(seed));
            read.whole["period"].push_back(period);
            read.numbers["certified"].push_back(row.certified);
            read.whole["unsafe"].push_back(row.unsafe ? 1 : 0);
            read.numbers["ocp_ms"].push_back(row.ocp_ms);
          });
      return read;
    });
    return as_arrays(std::move(columns));
  }

  [[nodiscard]] std::string status() const {
    return harness::status_json(harness::campaign_status(folder_));
  }

  [[nodiscard]] std::string statistics() const {
    return without_lock(
        [&] { return harness::campaign_json(harness::campaign_statistics(reader())); });
  }

  void verify() const {
    without_lock([&] { reader().verify(); });
  }

 private:
  [[nodiscard]] harness::StoreReader reader() const { return harness::StoreReader(folder_); }

  std::string folder_;
};

/// Drives the episodes that the folder lacks and writes the files of `qsmpc campaign`. Ctrl-C lets
/// running episodes finish, and a second one abandons them; finished ones are kept.
Store run_campaign(const std::string& campaign_file, const std::string& folder, int jobs,
                   bool update, bool retry_faults, const nb::object& on_progress) {
  harness::CampaignOptions options{
      .jobs = harness::usable_threads(jobs), .update = update, .retry_faults = retry_faults};
  options.should_stop = [] { return harness::interrupts() > 0; };
  options.should_hurry = [] { return harness::interrupts() > 1; };
  if (!on_progress.is_none()) {
    options.on_progress = [&](const harness::CampaignProgress& now) {
      const nb::gil_scoped_acquire lock;
      on_progress(now.done, now.total);
    };
  }
  without_lock([&] {
    const harness::InterruptPatience patience(2);
    (void)harness::run_campaign(harness::load_campaign(campaign_file), folder, options);
    harness::write_file(folder + "/" + harness::kCampaignCopy,
                        harness::read_text_file(harness::find_campaign(campaign_file)));
    (void)harness::write_campaign_results(folder);
  });
  return Store(folder);
}

}  // namespace

void add_campaigns(nb::module_& module) {
  nb::class_<Store>(module, "Store")
      .def(nb::init<std::string>(), "folder"_a)
      .def_prop_ro("folder", &Store::folder)
      .def_prop_ro("variants", &Store::variants)
      .def("episodes", &Store::episodes)
      .def("periods", &Store::periods, "variant"_a)
      .def("status_json", &Store::status)
      .def("statistics_json", &Store::statistics)
      .def("verify", &Store::verify);
  module.def("run_campaign", &run_campaign, "campaign"_a, "folder"_a, "jobs"_a, "update"_a,
             "retry_faults"_a, "on_progress"_a.none());
  module.def(
      "campaign_plan",
      [](const std::string& campaign) {
        return harness::campaign_plan_json(harness::load_campaign(campaign));
      },
      "campaign"_a);
}

}  // namespace qsmpc::python
