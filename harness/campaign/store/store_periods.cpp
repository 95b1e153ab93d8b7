#include "harness/campaign/store/store_periods.hpp"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <system_error>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::string_view kNull = "null";
constexpr const char* kInfinite = "9e999";  // read as infinity by SQLite and this file

void add_number(double value, std::string& text) {
  if (std::isnan(value)) {
    text += kNull;
  } else if (std::isinf(value)) {
    text += value < 0.0 ? "-" : "";
    text += kInfinite;
  } else {
    fmt::format_to(std::back_inserter(text), "{}", value);
  }
}

/// Parses the texts that this file writes.
class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : text_(text) {}

  /// Consumes the next character if it is `c`; returns whether it was.
  bool pass(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!pass(c)) refuse();
  }
  double number() {
    if (text_.starts_with(kNull)) {
      text_.remove_prefix(kNull.size());
      return kNotANumber;
    }
    double value = 0.0;
    const bool is_negative = !text_.empty() && text_.front() == '-';
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range) {
      value = is_negative ? -kInfinity : kInfinity;
    } else if (error != std::errc{}) {
      refuse();
    }
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }
  std::size_t index() {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc{}) refuse();
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }
  void finish() const {
    if (!text_.empty()) refuse();
  }
  [[noreturn]] static void refuse() {
    throw SQLite::Exception("an episode's periods are not a list of numbers");
  }

 private:
  std::string_view text_;
};

/// Calls `item` for every item of a list.
template <class Item>
void read_list(NumberReader& reader, const Item& item) {
  reader.expect('[');
  if (reader.pass(']')) return;
  do {
    item();
  } while (reader.pass(','));
  reader.expect(']');
}

/// Writes the rows of one episode.
class PeriodGathering {
 public:
  explicit PeriodGathering(SQLite::Database& database)
      : periods_(database, "INSERT INTO episode_periods VALUES (?, ?, ?, ?)"),
        times_(database, "INSERT INTO episode_ocp_ms VALUES (?, ?, ?)") {}

  void add(std::int64_t variant, std::int64_t seed, const std::vector<PeriodRow>& rows) {
    if (rows.empty()) return;
    for (SQLite::Statement* statement : {&periods_, &times_}) {
      statement->bind(1, variant);
      statement->bind(2, seed);
    }
    periods_.bind(3, certificates_text(rows));
    periods_.bind(4, unsafe_text(rows));
    times_.bind(3, ocp_ms_text(rows));
    for (SQLite::Statement* statement : {&periods_, &times_}) {
      statement->exec();
      statement->reset();
    }
  }

 private:
  SQLite::Statement periods_;
  SQLite::Statement times_;
};

}  // namespace

std::string certificates_text(const std::vector<PeriodRow>& periods) {
  std::string text = "[";
  for (const PeriodRow& period : periods) {
    text += text.size() == 1 ? "[" : ",[";
    add_number(period.certified, text);
    text += ',';
    add_number(period.published, text);
    text += ']';
  }
  return text + "]";
}

std::string unsafe_text(const std::vector<PeriodRow>& periods) {
  std::string text = "[";
  for (std::size_t k = 0; k < periods.size(); ++k) {
    if (periods[k].unsafe) text += fmt::format("{}{}", text.size() == 1 ? "" : ",", k);
  }
  return text + "]";
}

std::string ocp_ms_text(const std::vector<PeriodRow>& periods) {
  std::string text = "[";
  for (const PeriodRow& period : periods) {
    if (text.size() > 1) text += ',';
    add_number(period.ocp_ms, text);
  }
  return text + "]";
}

void read_periods(std::string_view certificates, std::string_view unsafe,
                  std::vector<PeriodRow>& periods) {
  periods.clear();
  NumberReader reader(certificates);
  read_list(reader, [&] {
    PeriodRow& period = periods.emplace_back();
    reader.expect('[');
    period.certified = reader.number();
    reader.expect(',');
    period.published = reader.number();
    reader.expect(']');
  });
  reader.finish();
  NumberReader numbers(unsafe);
  read_list(numbers, [&] {
    const std::size_t period = numbers.index();
    if (period >= periods.size()) NumberReader::refuse();
    periods[period].unsafe = true;
  });
  numbers.finish();
}

void read_ocp_ms(std::string_view text, std::vector<double>& values) {
  values.clear();
  NumberReader reader(text);
  read_list(reader, [&] { values.push_back(reader.number()); });
  reader.finish();
}

void gather_periods(SQLite::Database& database) {
  PeriodGathering gathering(database);
  SQLite::Statement rows(
      database,
      "SELECT p.variant, p.seed, p.certified, p.published, p.unsafe, t.ocp_ms FROM old_period p "
      "JOIN old_period_timing t USING (variant, seed, period) ORDER BY p.variant, p.seed, "
      "p.period");
  const auto number = [&](int column) {
    return rows.getColumn(column).isNull() ? kNotANumber : rows.getColumn(column).getDouble();
  };
  std::vector<PeriodRow> periods;
  std::int64_t variant = 0;
  std::int64_t seed = 0;
  while (rows.executeStep()) {
    const std::int64_t of_variant = rows.getColumn(0).getInt64();
    const std::int64_t of_seed = rows.getColumn(1).getInt64();
    if (of_variant != variant || of_seed != seed) {
      gathering.add(variant, seed, periods);
      periods.clear();
    }
    variant = of_variant;
    seed = of_seed;
    periods.push_back({.certified = number(2),
                       .published = number(3),
                       .unsafe = rows.getColumn(4).getInt() != 0,
                       .ocp_ms = rows.getColumn(5).getDouble()});
  }
  gathering.add(variant, seed, periods);
}

}  // namespace qsmpc::harness
