// The problems of a campaign, each noted once: what is wrong with one value shows in every variant
// that has it.
#pragma once

#include <string>
#include <unordered_set>

#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

class CampaignRefusals {
 public:
  /// `file`: of the campaign. `problems` takes them, and must outlive it.
  CampaignRefusals(std::string file, Problems& problems);

  /// Notes a problem at a place of the campaign's file.
  void add(const CampaignPlace& place, std::string found, std::string expected);
  /// Notes a problem of another file.
  void add(InputError::Where where);

  [[nodiscard]] bool empty() const { return seen_.empty(); }
  /// Whether there are more than anyone reads.
  [[nodiscard]] bool many() const;

 private:
  std::string file_;
  Problems* problems_;
  std::unordered_set<std::string> seen_;
};

}  // namespace qsmpc::harness
