#include "harness/scenario/keys/listed_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace qsmpc::harness {
namespace {

/// The numbers of a row; if an entry is not a number, nothing, and the entry in `found`.
std::optional<Eigen::VectorXd> numbers_of(const YamlNode& row, std::string& found) {
  Eigen::VectorXd numbers(std::ssize(row.items));
  for (Eigen::Index k = 0; k < numbers.size(); ++k) {
    const YamlNode& item = row.items[static_cast<std::size_t>(k)];
    const std::optional<double> number = parse_number(item);
    if (!number || !std::isfinite(*number)) {
      found = fmt::format("{} at position {}", describe(item), k + 1);
      return std::nullopt;
    }
    numbers[k] = *number;
  }
  return numbers;
}

}  // namespace

std::optional<std::vector<Eigen::VectorXd>> read_rows(Section& section, const std::string& key,
                                                      const RowForm& form) {
  const std::size_t count = section.list_size(key);
  const YamlNode& list = *section.tree(key);
  if (list.kind != YamlNode::Kind::kList) return std::nullopt;  // already noted
  if (count < form.least || count > form.most) {
    section.note(key,
                 fmt::format("{} to {} {}, {} each", form.least, form.most, form.name, form.words),
                 fmt::format("{} {}", count, form.name));
    return std::nullopt;
  }
  std::vector<Eigen::VectorXd> rows;
  rows.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const YamlNode& row = list.items[i];
    const bool is_row = row.kind == YamlNode::Kind::kList &&
                        std::ranges::find(form.widths, row.items.size()) != form.widths.end();
    std::string found;  // the entry that is not a number, else the row itself
    const auto numbers = is_row ? numbers_of(row, found) : std::nullopt;
    if (!numbers) {
      section.note_item(key, i, form.words, std::move(found));
      return std::nullopt;
    }
    if (form.alike && i > 0 && numbers->size() != rows.front().size()) {
      section.note_item(key, i,
                        fmt::format("{} numbers, as in the previous rows", rows.front().size()));
      return std::nullopt;
    }
    rows.push_back(*numbers);
  }
  return rows;
}

Eigen::MatrixXd matrix_of(const std::vector<Eigen::VectorXd>& rows) {
  Eigen::MatrixXd matrix(std::ssize(rows), rows.empty() ? 0 : rows.front().size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    matrix.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  }
  return matrix;
}

}  // namespace qsmpc::harness
