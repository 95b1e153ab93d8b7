// Every reader of external text reads or refuses its seeds, which include past findings, and
// variations of them. scripts/fuzz searches further, guided by coverage.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::testing {
namespace fuzz_seeds_test {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

using Draw = std::mt19937_64;

std::size_t below(std::size_t count, Draw& draw) { return count == 0 ? 0 : draw() % count; }

/// A few of the changes that typically break parsers.
std::string varied(std::string text, const std::string& other, Draw& draw) {
  static const std::vector<std::string> tokens = {"[",
                                                  "]",
                                                  "{",
                                                  "}",
                                                  ":",
                                                  "\n",
                                                  ", ",
                                                  "-",
                                                  "#",
                                                  "\"",
                                                  "'",
                                                  "&a ",
                                                  "*a ",
                                                  ".inf",
                                                  ".nan",
                                                  "1e999",
                                                  "-1e-320",
                                                  "0",
                                                  "99999999999999999999",
                                                  "true",
                                                  "~",
                                                  "\t",
                                                  std::string(1, '\0'),
                                                  "\xff",
                                                  "  "};
  const std::size_t changes = 1 + below(4, draw);
  for (std::size_t n = 0; n < changes; ++n) {
    const std::size_t at = below(text.size() + 1, draw);
    const std::size_t length = below(std::min<std::size_t>(20, text.size() - at) + 1, draw);
    switch (draw() % 4) {
      case 0:
        text.replace(at, length, tokens[below(tokens.size(), draw)]);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      default: {
        const std::size_t from = below(other.size(), draw);
        text.replace(at, length, other.substr(from, below(40, draw)));
      }
    }
  }
  return text;
}

class FuzzSeeds : public ::testing::TestWithParam<std::string> {
 protected:
  FuzzSeeds() {
    for (const std::string& path : fuzz_seeds(target_)) seeds_.push_back({path, bytes_of(path)});
  }

  struct Seed {
    std::string path;
    std::string bytes;
  };
  const FuzzTarget& target_ = fuzz_target(GetParam());
  std::vector<Seed> seeds_{};
};

TEST_P(FuzzSeeds, are_read_or_refused) {
  ASSERT_GE(seeds_.size(), 3U);
  for (const Seed& seed : seeds_) EXPECT_NO_THROW(target_.read(seed.bytes)) << seed.path;
}

TEST_P(FuzzSeeds, are_read_or_refused_in_variations) {
  Draw draw(29);
  const int variations = by_effort(100, 400, 20000);
  for (int n = 0; n < variations; ++n) {
    const Seed& seed = seeds_[below(seeds_.size(), draw)];
    const Seed& other = seeds_[below(seeds_.size(), draw)];
    const std::string bytes = varied(seed.bytes, other.bytes, draw);
    ASSERT_NO_THROW(target_.read(bytes)) << seed.path << " as\n" << bytes;
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const FuzzTarget& target : fuzz_targets()) all.push_back(target.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(of, FuzzSeeds, ::testing::ValuesIn(names()),
                         [](const auto& each) { return each.param; });

}  // namespace fuzz_seeds_test
}  // namespace qsmpc::testing
