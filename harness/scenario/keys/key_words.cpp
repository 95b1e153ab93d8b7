#include "harness/scenario/keys/key_words.hpp"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace qsmpc::harness {
namespace {

constexpr std::string_view kRangeMark = "{range}";
constexpr std::string_view kNamesMark = "{names}";
constexpr std::string_view kLongestMark = "{longest}";
constexpr int kLeastExponent = 5;  // of ten, from which a number is written as a power

/// -12 as "⁻¹²".
std::string superscript(int exponent) {
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "⁻" : "";
  for (const char digit : fmt::format("{}", std::abs(exponent))) out += digits[digit - '0'];
  return out;
}

std::string number_words(double value) {
  if (value > 0.0) {
    const int exponent = static_cast<int>(std::lround(std::log10(value)));
    const bool is_power = value == std::stod(fmt::format("1e{}", exponent));
    if (is_power && std::abs(exponent) >= kLeastExponent) return "10" + superscript(exponent);
  }
  return fmt::format("{}", value);
}

/// 100000 as "100 000"; the largest representable numbers as powers.
std::string whole_words(std::uint64_t value) {
  if (value == std::numeric_limits<std::uint64_t>::max()) return "2⁶⁴ − 1";
  if (value == static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return "2⁶³ − 1";
  }
  std::string digits = fmt::format("{}", value);
  if (digits.size() <= 4) return digits;
  for (std::size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, " ");
  return digits;
}

struct RangeWords {
  std::string operator()(const NumberValue& value) const { return of(value.range); }
  std::string operator()(const VectorValue& value) const { return of(value.range); }
  std::string operator()(const WholeValue& value) const {
    return whole_words(value.least) + " to " + whole_words(value.most);
  }
  template <class Value>
  std::string operator()(const Value& /*value*/) const {
    return "";
  }

 private:
  static std::string of(const NumberRange& range) {
    const bool has_least = std::isfinite(range.least);
    const bool has_most = std::isfinite(range.most);
    if (has_least && has_most && !range.above_least) {
      return number_words(range.least) + " to " + number_words(range.most);
    }
    std::string out;
    if (has_least) out = (range.above_least ? "> " : "≥ ") + number_words(range.least);
    if (has_most) out += (out.empty() ? "" : ", ") + ("up to " + number_words(range.most));
    return out;
  }
};

/// The names that a key accepts; nullptr if it accepts none.
const std::vector<std::string>* names_of_key(const KeyDescription& key) {
  for (const KeyValue& value : key.values) {
    if (const auto* name = std::get_if<NameValue>(&value)) return &name->known;
    if (const auto* list = std::get_if<ListValue>(&value)) return names_of_key(list->item.front());
  }
  return nullptr;
}

/// "`a`, `b` or `c`"
std::string names_words(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const char* joint = i == 0 ? "" : i + 1 == names.size() ? " or " : ", ";
    out += fmt::format("{}`{}`", joint, names[i]);
  }
  return out;
}

bool replace_mark(std::string& text, std::string_view mark, const std::string& by) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return false;
  text.replace(at, mark.size(), by);
  return true;
}

}  // namespace

std::string range_words(const KeyDescription& key) {
  return key.values.empty() ? "" : std::visit(RangeWords{}, key.values.front());
}

std::string filled_words(const KeyDescription& key) {
  std::string words = key.words;
  const std::string range = range_words(key);
  const bool says_range = replace_mark(words, kRangeMark, range);
  const bool takes_one =
      !key.values.empty() && !std::holds_alternative<VectorValue>(key.values.front());
  if (!says_range && takes_one && !range.empty() && !words.empty()) words += ", " + range;
  if (const auto* names = names_of_key(key)) replace_mark(words, kNamesMark, names_words(*names));
  if (!key.values.empty()) {
    if (const auto* text = std::get_if<TextValue>(&key.values.front())) {
      replace_mark(words, kLongestMark, fmt::format("{}", text->longest));
    }
  }
  return words;
}

}  // namespace qsmpc::harness
