#include "harness/campaign/store/store_periods.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace store_periods_test {

std::vector<PeriodRow> example_periods() {
  return {{.certified = 0.1 + 0.2, .published = 1.0, .unsafe = false, .ocp_ms = 1.0 / 3.0},
          {.certified = 5e-324, .published = -0.0, .unsafe = true, .ocp_ms = 1e300},
          {.certified = kInfinity, .published = -kInfinity, .unsafe = true, .ocp_ms = 0.0}};
}

std::vector<PeriodRow> read_back(const std::vector<PeriodRow>& periods) {
  std::vector<PeriodRow> read;
  std::vector<double> times;
  read_periods(certificates_text(periods), unsafe_text(periods), read);
  read_ocp_ms(ocp_ms_text(periods), times);
  EXPECT_EQ(times.size(), read.size());
  for (std::size_t k = 0; k < times.size(); ++k) read[k].ocp_ms = times[k];
  return read;
}

TEST(StorePeriods, read_back_as_they_were) {
  const std::vector<PeriodRow> read = read_back(example_periods());
  EXPECT_EQ(read, example_periods());
  EXPECT_TRUE(std::signbit(read[1].published));
  EXPECT_EQ(read_back({}), std::vector<PeriodRow>{});
}

TEST(StorePeriods, what_is_not_a_number_is_null) {
  const std::vector<PeriodRow> periods{{.certified = kNotANumber, .published = 0.5}};
  EXPECT_EQ(certificates_text(periods), "[[null,0.5]]");
  EXPECT_TRUE(std::isnan(read_back(periods)[0].certified));
}

TEST(StorePeriods, are_json_that_sqlite_reads) {
  SQLite::Database database(":memory:", SQLite::OPEN_READWRITE);
  SQLite::Statement statement(database, "SELECT json_valid(?), json_valid(?), json_valid(?)");
  const std::vector<PeriodRow> periods = example_periods();
  statement.bind(1, certificates_text(periods));
  statement.bind(2, unsafe_text(periods));
  statement.bind(3, ocp_ms_text(periods));
  ASSERT_TRUE(statement.executeStep());
  for (int column = 0; column < 3; ++column) EXPECT_EQ(statement.getColumn(column).getInt(), 1);
  EXPECT_EQ(unsafe_text(periods), "[1,2]");
}

TEST(StorePeriods, refuses_invalid_texts) {
  std::vector<PeriodRow> periods;
  std::vector<double> times;
  for (const char* text : {"", "[", "[[1,2]", "[[1,2]].", "[[1]]", "[1,2]", "[[1,2],]", "[[a,2]]",
                           "[[1,2,3]]", "{}"}) {
    EXPECT_THROW(read_periods(text, "[]", periods), SQLite::Exception) << text;
  }
  for (const char* text : {"", "[0", "[1]", "[-1]", "[0.5]", "[0]."}) {
    EXPECT_THROW(read_periods("[[1,2]]", text, periods), SQLite::Exception) << text;
  }
  for (const char* text : {"", "[1", "[1]x", "[1,]", "1"}) {
    EXPECT_THROW(read_ocp_ms(text, times), SQLite::Exception) << text;
  }
}

}  // namespace store_periods_test
}  // namespace qsmpc::harness
