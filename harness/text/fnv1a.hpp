// FNV-1a: a digest of bytes that is the same on every machine and in every version, and that
// changes with any single bit. It does not resist deliberate collisions.
#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>

namespace qsmpc::harness {

/// Word: std::uint32_t or std::uint64_t.
template <class Word>
requires std::same_as<Word, std::uint32_t> || std::same_as<Word, std::uint64_t>
class Fnv1a {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) add_byte(static_cast<unsigned char>(byte));
  }

  /// Adds the eight bytes of `number`, least significant first.
  void add(std::uint64_t number) {
    if (number < 256) {  // the seven zero bytes only multiply
      state_ = (state_ ^ static_cast<Word>(number)) * kPrimeToTheEighth;
      return;
    }
    for (int n = 0; n < 8; ++n) add_byte(static_cast<unsigned char>(number >> (8 * n)));
  }

  [[nodiscard]] Word value() const { return state_; }

 private:
  static constexpr bool kIsShort = sizeof(Word) == 4;
  static constexpr Word kPrime = kIsShort ? Word{0x01000193U} : static_cast<Word>(0x100000001b3U);

  static constexpr Word kPrimeSquared = kPrime * kPrime;
  static constexpr Word kPrimeToTheEighth =
      kPrimeSquared * kPrimeSquared * kPrimeSquared * kPrimeSquared;

  void add_byte(unsigned char byte) { state_ = (state_ ^ byte) * kPrime; }

  Word state_ = kIsShort ? Word{0x811c9dc5U} : static_cast<Word>(0xcbf29ce484222325U);
};

}  // namespace qsmpc::harness
