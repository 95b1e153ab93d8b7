#include "harness/prediction/input_table.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/value_checks.hpp"
#include "harness/text/number_parse.hpp"
#include "harness/text/text_encoding.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlank = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

/// Reads the lines of one table.
class TableReader {
 public:
  TableReader(std::string file, const InputTableFormat& format)
      : file_(std::move(file)), format_(format) {
    for (const models::Coordinate& input : format.inputs) names_.push_back(input.name);
    for (std::size_t i = 0; i < names_.size(); ++i) order_.push_back(i);
  }

  Eigen::MatrixXd read(std::string_view text) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    std::vector<std::string_view> lines = split(text, '\n');
    while (!lines.empty() && lines.back().empty()) lines.pop_back();
    for (const std::string_view line : lines) {
      ++line_;
      if (format_.stages && std::ssize(rows_) == *format_.stages) break;
      read_line(line);
    }
    return table();
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& found,
                           const std::string& expected) const {
    throw InputError(
        {.file = file_, .line = line_, .key = key, .found = found, .expected = expected});
  }

  void read_line(std::string_view line) {
    const std::vector<std::string_view> cells = split(line, ',');
    if (line.empty()) refuse("", "an empty line", expected_row());
    if (cells.size() != names_.size()) {
      refuse("", fmt::format("{} column{}", cells.size(), cells.size() == 1 ? "" : "s"),
             expected_row());
    }
    const bool no_number = std::none_of(cells.begin(), cells.end(), [](std::string_view cell) {
      return cell.empty() || parse_decimal(cell).has_value();
    });
    if (line_ == 1 && no_number) {
      read_header(cells);
    } else {
      read_numbers(cells);
    }
  }

  void read_header(const std::vector<std::string_view>& cells) {
    for (std::size_t column = 0; column < cells.size(); ++column) {
      const auto known = std::find(names_.begin(), names_.end(), cells[column]);
      const std::string key = fmt::format("column {}", column + 1);
      if (known == names_.end()) {
        refuse(key, std::string(cells[column]),
               "a number, or the name of an input: " + expected_names(cells[column], names_));
      }
      const auto here = cells.begin() + static_cast<std::ptrdiff_t>(column);
      if (std::find(cells.begin(), here, *here) != here) {
        refuse(key, std::string(*here) + " a second time", "each input once");
      }
      order_[column] = static_cast<std::size_t>(known - names_.begin());
    }
  }

  void read_numbers(const std::vector<std::string_view>& cells) {
    if (std::ssize(rows_) == kMostStages) {
      refuse("", fmt::format("more than {} rows", kMostStages), "one row per stage, no more");
    }
    Eigen::VectorXd row(format_.bounds.lower.size());
    for (std::size_t column = 0; column < cells.size(); ++column) {
      const std::size_t input = order_[column];
      const std::string key = fmt::format("column {} ({})", column + 1, names_[input]);
      const std::optional<double> value = parse_decimal(cells[column]);
      const std::string found = cells[column].empty() ? "nothing" : std::string(cells[column]);
      if (!value) refuse(key, found, "a finite number");
      const auto i = static_cast<Eigen::Index>(input);
      const double lower = format_.bounds.lower[i];
      const double upper = format_.bounds.upper[i];
      if (*value < lower || *value > upper) {
        refuse(key, found,
               fmt::format("a number from {} to {}, the bounds of the input", lower, upper));
      }
      row[i] = *value;
    }
    rows_.push_back(std::move(row));
  }

  [[nodiscard]] std::string expected_row() const {
    return fmt::format("{} number{} separated by commas: {}", names_.size(),
                       names_.size() == 1 ? "" : "s", fmt::join(names_, ", "));
  }

  [[nodiscard]] Eigen::MatrixXd table() const {
    const auto count = std::ssize(rows_);
    if (count == 0 || (format_.stages && count < *format_.stages)) {
      throw InputError({.file = file_,
                        .found = fmt::format("{} rows", count),
                        .expected = format_.stages
                                        ? fmt::format("at least {}, one per stage", *format_.stages)
                                        : "at least one row: " + expected_row()});
    }
    Eigen::MatrixXd inputs(format_.bounds.lower.size(), count);
    for (Eigen::Index k = 0; k < count; ++k) inputs.col(k) = rows_[static_cast<std::size_t>(k)];
    return inputs;
  }

  std::string file_;
  const InputTableFormat& format_;
  std::vector<std::string> names_;
  std::vector<std::size_t> order_;  // input index of each column
  int line_ = 0;
  std::vector<Eigen::VectorXd> rows_;
};

}  // namespace

Eigen::MatrixXd parse_input_table(const std::string& text, const std::string& file,
                                  const InputTableFormat& format) {
  if (const auto problem = find_text_problem(text)) {
    throw InputError({.file = file,
                      .line = problem->line,
                      .found = problem->found,
                      .expected = "a CSV file in UTF-8"});
  }
  return TableReader(file, format).read(text);
}

Eigen::MatrixXd read_input_table(const std::string& path, const InputTableFormat& format) {
  return parse_input_table(read_text_file(path), path, format);
}

}  // namespace qsmpc::harness
