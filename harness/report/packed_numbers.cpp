#include "harness/report/packed_numbers.hpp"

#include <bit>
#include <cstddef>
#include <limits>

#include "harness/text/base64.hpp"

namespace qsmpc::harness {
namespace {

template <class Word>
std::string packed(const std::vector<Word>& words) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(words.size() * sizeof(Word));
  for (const Word word : words) {
    for (std::size_t i = 0; i < sizeof(Word); ++i) {
      bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(word) >> (8U * i)));
    }
  }
  return base64(bytes);
}

}  // namespace

std::string packed_floats(const std::vector<double>& values) {
  static_assert(std::numeric_limits<float>::is_iec559);
  std::vector<std::uint32_t> words;
  words.reserve(values.size());
  for (const double value : values) {
    words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  return packed(words);
}

std::string packed_words(const std::vector<std::uint16_t>& values) { return packed(values); }

std::string packed_bytes(const std::vector<std::uint8_t>& values) { return base64(values); }

}  // namespace qsmpc::harness
