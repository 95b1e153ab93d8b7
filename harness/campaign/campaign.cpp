#include "harness/campaign/campaign.hpp"

#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::string_view kTo = " to ";
constexpr std::string_view kComma = ", ";

std::uint64_t seed_from_text(std::string_view text) {
  const auto seed = parse_integer<std::uint64_t>(text);
  if (!seed) throw std::invalid_argument("seeds: not a seed: \"" + std::string(text) + "\"");
  return *seed;
}

}  // namespace

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

std::string seeds_text(const SeedSet& seeds) {
  if (!seeds.listed.empty()) return fmt::format("{}", fmt::join(seeds.listed, kComma));
  return fmt::format("{}{}{}", seeds.first, kTo, seeds.at(seeds.count - 1));
}

SeedSet seeds_from_text(const std::string& text) {
  std::string_view rest = text;
  if (const std::size_t to = rest.find(kTo); to != std::string_view::npos) {
    const std::uint64_t first = seed_from_text(rest.substr(0, to));
    const std::uint64_t last = seed_from_text(rest.substr(to + kTo.size()));
    if (last < first) throw std::invalid_argument("seeds: the last is before the first");
    return {.first = first, .count = static_cast<std::int64_t>(last - first + 1)};
  }
  SeedSet seeds;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = rest.find(kComma);
    seeds.listed.push_back(seed_from_text(rest.substr(0, comma)));
    if (comma != std::string_view::npos) rest.remove_prefix(comma + kComma.size());
  }
  return seeds;
}

SeedPlaces::SeedPlaces(const SeedSet& seeds)
    : first_(seeds.first), count_(seeds.listed.empty() ? seeds.count : 0) {
  for (std::size_t i = 0; i < seeds.listed.size(); ++i) {
    listed_.emplace(seeds.listed[i], static_cast<std::int64_t>(i));
  }
}

std::optional<std::int64_t> SeedPlaces::of(std::uint64_t seed) const {
  if (const auto found = listed_.find(seed); found != listed_.end()) return found->second;
  if (seed < first_ || seed - first_ >= static_cast<std::uint64_t>(count_)) return std::nullopt;
  return static_cast<std::int64_t>(seed - first_);
}

std::string until_text(const std::optional<StopCriterion>& until) {
  if (!until) return "none";
  return fmt::format("{} to +-{} at {} %", until->of, until->rate_halfwidth,
                     100.0 * until->confidence);
}

std::string traces_text(const Campaign& campaign) {
  const char* name = trace_keeping_name(campaign.traces);
  if (campaign.traces != TraceKeeping::kFailures) return name;
  return fmt::format("{}, sample {}", name, campaign.trace_sample);
}

std::string rare_text(const Campaign& campaign) {
  if (!campaign.rare) return {};
  const SplitSettings& splitting = campaign.rare->splitting;
  return fmt::format("{} particles, {} killed, floor {}, {}", splitting.particles, splitting.killed,
                     splitting.floor, campaign.rare->certify ? "certified" : "not certified");
}

}  // namespace qsmpc::harness
