#include "harness/cluster/launch_file.hpp"

#include <nlohmann/json.hpp>

#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/shared_files.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kLaunchFile = "launch.json";

}  // namespace

std::optional<TaskLaunch> read_task_launch(const std::string& folder) {
  const std::string path = cluster_path(folder, kLaunchFile);
  const std::optional<std::string> text = read_shared_file(path);
  if (!text) return std::nullopt;
  try {
    const auto json = nlohmann::ordered_json::parse(*text);
    return TaskLaunch{
        .launch = json.at("launch"),
        .options = json.at("options"),
        .record = json.at("record"),
        .jobs = json.at("jobs"),
        .lost_after = std::chrono::seconds(json.at("lost_after").get<std::int64_t>())};
  } catch (const nlohmann::json::exception& error) {
    throw IoError(path + ": cannot be read: " + error.what());
  }
}

void write_task_launch(const TaskLaunch& record, const std::string& folder) {
  const nlohmann::ordered_json json = {{"launch", record.launch},
                                       {"options", record.options},
                                       {"record", record.record},
                                       {"jobs", record.jobs},
                                       {"lost_after", record.lost_after.count()}};
  write_file(cluster_path(folder, kLaunchFile), json_text(json));
}

}  // namespace qsmpc::harness
