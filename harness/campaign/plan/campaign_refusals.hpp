// Collects the problems of a campaign without duplicates: a problem with one value shows up in
// every variant that has it.
#pragma once

#include <string>
#include <unordered_set>

#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

class CampaignRefusals {
 public:
  /// `file`: the campaign's. `problems` receives the problems and must outlive this object.
  CampaignRefusals(std::string file, Problems& problems);

  /// Adds a problem at a place in the campaign's file.
  void add(const CampaignPlace& place, std::string found, std::string expected);
  /// Adds a problem in another file.
  void add(InputError::Where where);

  [[nodiscard]] bool empty() const { return seen_.empty(); }
  /// Whether there are so many problems that looking for more is pointless.
  [[nodiscard]] bool many() const;

 private:
  std::string file_;
  Problems* problems_;
  std::unordered_set<std::string> seen_;
};

}  // namespace qsmpc::harness
