#include "harness/scenario/path_file.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/keys/shape_keys.hpp"
#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kExpectedRow = "x, y or x, y, right width, left width in m";
constexpr double kLeastApart = 1e-6;  // m, of successive points
constexpr std::size_t kPlaceNumbers = 2;
constexpr std::size_t kWidthNumbers = 4;

/// The words of a line between separators.
std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kSeparators = ",; \t\r";
  std::vector<std::string_view> words;
  line = line.substr(0, line.find('#'));
  while (true) {
    const std::size_t begin = line.find_first_not_of(kSeparators);
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

/// The lines of a path file, up to the first invalid one.
class PathLines {
 public:
  PathLines(const std::string& path, Problems& problems) : path_(path), problems_(problems) {}

  std::optional<PathRows> read(std::string_view text) {
    int number = 0;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++number;
      if (!take(text.substr(0, end), number)) return std::nullopt;
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    PathRows read{.rows = Eigen::MatrixXd(std::ssize(lines_), width_), .lines = lines_};
    for (Eigen::Index i = 0; i < read.rows.size(); ++i) {
      read.rows(i / width_, i % width_) = numbers_[i];
    }
    return read;
  }

 private:
  bool take(std::string_view line, int number) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty()) return true;
    std::vector<double> numbers;
    for (const std::string_view word : words) {
      if (const std::optional<double> value = parse_decimal(word)) numbers.push_back(*value);
    }
    const bool is_first = lines_.empty() && !has_names_;
    if (numbers.empty() && is_first) return has_names_ = true;
    const bool is_row = words.size() == kPlaceNumbers || words.size() == kWidthNumbers;
    if (numbers.size() != words.size() || !is_row) return note(number, std::string(line));
    if (width_ == 0) width_ = static_cast<Eigen::Index>(words.size());
    if (static_cast<Eigen::Index>(words.size()) != width_) {
      return note(number, fmt::format("a row of {} numbers", words.size()),
                  fmt::format("{} numbers, as in the previous rows", width_));
    }
    if (lines_.size() == kMostPathRows) {
      return note(number, "one more", fmt::format("at most {} points", kMostPathRows));
    }
    numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
    lines_.push_back(number);
    return true;
  }

  bool note(int line, std::string found, std::string expected = kExpectedRow) {
    constexpr std::size_t kShown = 60;
    if (found.size() > kShown) found = found.substr(0, kShown) + "…";
    problems_.add({.file = path_, .line = line, .found = found, .expected = std::move(expected)});
    return false;
  }

  const std::string& path_;
  Problems& problems_;
  bool has_names_ = false;
  Eigen::Index width_ = 0;
  std::vector<double> numbers_;
  std::vector<int> lines_;
};

}  // namespace

std::optional<PathRows> read_path_file(const std::string& path, Problems& problems) {
  try {
    return PathLines(path, problems).read(read_text_file(path));
  } catch (const InputError& error) {
    problems.add(error.where());
    return std::nullopt;
  }
}

bool check_path_rows(const Eigen::MatrixXd& rows, bool closed, const RowNote& note) {
  const Eigen::Index least = closed ? 3 : 2;
  if (rows.rows() < least) {
    note(0, fmt::format("{} points", rows.rows()),
         fmt::format("at least {} points for {} path", least, closed ? "a closed" : "an open"));
    return false;
  }
  const Eigen::Index pairs = closed ? rows.rows() : rows.rows() - 1;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto row = rows.row(i);
    if (!(row.head<2>().cwiseAbs().maxCoeff() <= kShapePlaces.most)) {
      note(i, fmt::format("the point ({:g}, {:g})", row[0], row[1]), "numbers from -1e7 to 1e7");
      return false;
    }
    if (row.size() > 2 &&
        !(row.tail<2>().minCoeff() > 0.0 && row.tail<2>().maxCoeff() <= kShapeSizes.most)) {
      note(i, fmt::format("the widths {:g} and {:g}", row[2], row[3]),
           "widths above 0 and up to 1e7");
      return false;
    }
    if (i == pairs) continue;
    const auto next = rows.row((i + 1) % rows.rows());
    if ((next.head<2>() - row.head<2>()).norm() >= kLeastApart) continue;
    note((i + 1) % rows.rows(), "the previous point again", "another point");
    return false;
  }
  return true;
}

bool comes_back(const Eigen::MatrixXd& rows) {
  if (rows.rows() < 4) return false;
  double most = 0.0;
  for (Eigen::Index i = 1; i < rows.rows(); ++i) {
    most = std::max(most, (rows.row(i) - rows.row(i - 1)).head<2>().norm());
  }
  const double back = (rows.row(rows.rows() - 1) - rows.row(0)).head<2>().norm();
  constexpr double kAsNear = 1.1;
  return back <= kAsNear * most;
}

}  // namespace qsmpc::harness
