#include "harness/campaign/plan/campaign_refusals.hpp"

#include <cstddef>
#include <utility>

namespace qsmpc::harness {
namespace {

constexpr std::size_t kMany = 100;  // the number that Problems keeps

}  // namespace

CampaignRefusals::CampaignRefusals(std::string file, Problems& problems)
    : file_(std::move(file)), problems_(&problems) {}

void CampaignRefusals::add(const CampaignPlace& place, std::string found, std::string expected) {
  add({.file = file_,
       .line = place.line,
       .key = place.path,
       .found = std::move(found),
       .expected = std::move(expected)});
}

void CampaignRefusals::add(InputError::Where where) {
  if (seen_.insert(InputError(where).what()).second) problems_->add(std::move(where));
}

bool CampaignRefusals::many() const { return seen_.size() >= kMany; }

}  // namespace qsmpc::harness
