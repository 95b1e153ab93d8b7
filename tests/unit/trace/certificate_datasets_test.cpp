#include "harness/trace/certificate_datasets.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/trace/cost_fields.hpp"
#include "harness/trace/file_header.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace certificate_datasets_test {

using ::testing::ElementsAre;
using testing::TemporaryFolder;

const DatasetSpec& dataset(const std::vector<DatasetSpec>& layout, const std::string& path) {
  return *std::ranges::find(layout, path, &DatasetSpec::path);
}

TEST(CertificateLayout, a_row_is_a_stage_or_a_step_of_all_stages) {
  const std::vector<DatasetSpec> once = certificate_layout();
  const std::vector<DatasetSpec> stepwise = certificate_layout(3);
  // Drives have no C5, which is not computed during a drive.
  ASSERT_EQ(once.size(), stepwise.size() + 1);
  EXPECT_NE(std::ranges::find(once, "/certificate/conditioned", &DatasetSpec::path), once.end());
  EXPECT_EQ(std::ranges::find(stepwise, "/certificate/conditioned", &DatasetSpec::path),
            stepwise.end());
  EXPECT_THAT(dataset(once, "/certificate/budget").row_shape, ElementsAre(4));
  EXPECT_THAT(dataset(stepwise, "/certificate/budget").row_shape, ElementsAre(4, 4));
  EXPECT_THAT(dataset(stepwise, "/certificate/budget").axes,
              ElementsAre("step", "stage", "source"));
  EXPECT_TRUE(dataset(once, "/certificate/value").row_shape.empty());
  EXPECT_THAT(dataset(stepwise, "/certificate/lipschitz").row_shape, ElementsAre(4));
  EXPECT_THAT(dataset(stepwise, "/certificate/value").row_shape, ElementsAre(3));
}

TEST(CertificateDatasets, what_is_appended_is_read_back) {
  const TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  for (const DatasetSpec& spec : certificate_layout()) file.create_dataset(spec);
  write_file_header(file, {.kind = "test",
                           .schema = 7,
                           .version = "v",
                           .scenario_text = "name: a",
                           .scenario_name = "a",
                           .seed = 11});
  controller::StageBudget budget;
  budget.belief = 1.0;
  budget.total = 2.0;
  budget.model = 3.0;
  controller::StageCertificate certificate = controller::blank_certificate();
  certificate.figures[controller::certificate_index("c3")] = 0.5;
  certificate.value = 0.25;
  certificate.kind = "c2";
  append_certificates(file, {budget, budget}, {certificate});
  file.close();

  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  EXPECT_EQ(read.text("/", "kind"), "test");
  EXPECT_EQ(read.integer("/", "schema"), 7);
  EXPECT_EQ(read.text("/", "scenario"), "name: a");
  EXPECT_EQ(read.unsigned_integer("/", "seed"), 11U);
  EXPECT_THAT(read.doubles("/certificate/budget"), ElementsAre(1, 0, 0, 2, 1, 0, 0, 2));
  EXPECT_THAT(read.doubles("/certificate/model"), ElementsAre(3, 3));
  EXPECT_THAT(read.doubles("/certificate/value"), ElementsAre(0.25));
  EXPECT_THAT(read.doubles("/certificate/surrogate"), ElementsAre(0.5));
  EXPECT_THAT(read.doubles("/certificate/smoothed"), ElementsAre(1.0));
  EXPECT_THAT(read.doubles("/certificate/conditioned"), ElementsAre(1.0));
  EXPECT_THAT(read.doubles("/certificate/unsafe_mass"), ElementsAre(0.0));
  EXPECT_THAT(read.texts("/certificate/kind"), ElementsAre("c2"));
}

TEST(CostFields, hold_every_part_once) {
  const controller::CostParts cost{
      {"state", 1}, {"input", 2}, {"terminal", 4}, {"box", 8}, {"obstacle", 16}};
  EXPECT_THAT(cost_row(cost), ElementsAre(1, 2, 4, 8, 16));
  EXPECT_THAT(cost_part_names(), ElementsAre("state", "input", "terminal", "box", "obstacle"));
}

}  // namespace certificate_datasets_test
}  // namespace qsmpc::harness
