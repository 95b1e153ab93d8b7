// The parts of the expected cost (Eq. 4-21), by name.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// The sum of one or more terms of the cost (cost_terms.hpp), as named in files, pages and charts.
struct CostPartEntry {
  std::string name;   ///< of the column, e.g. "terminal"
  std::string words;  ///< e.g. "distance at the plan's end"
};

/// The parts in the order in which they are summed and written.
[[nodiscard]] const std::vector<CostPartEntry>& cost_parts();

/// The index of the part called `name` in cost_parts(). Throws std::invalid_argument if there is
/// none.
[[nodiscard]] std::size_t cost_part(std::string_view name);

/// A number for each part, 0 unless set.
class CostParts {
 public:
  /// The largest number of parts: fixed, so that no cost allocates.
  static constexpr std::size_t kMost = 8;

  CostParts() = default;
  /// Throws std::invalid_argument on an unknown name.
  CostParts(std::initializer_list<std::pair<std::string_view, double>> parts);
  /// The same number for every part.
  [[nodiscard]] static CostParts all(double value);

  [[nodiscard]] double operator[](std::size_t part) const { return values_[part]; }
  double& operator[](std::size_t part) { return values_[part]; }
  /// Throws std::invalid_argument on an unknown name.
  [[nodiscard]] double of(std::string_view name) const { return values_[cost_part(name)]; }

  void add(const CostParts& other) {
    for (std::size_t part = 0; part < kMost; ++part) values_[part] += other.values_[part];
  }

  /// The sum of all parts, in their order.
  [[nodiscard]] double total() const;

 private:
  std::array<double, kMost> values_{};
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
