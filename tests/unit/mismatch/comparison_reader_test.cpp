#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "controller/control/controller.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/mismatch/comparison_file.hpp"
#include "tests/unit/mismatch/mismatch_fixture.hpp"

namespace qsmpc::harness {
namespace comparison_reader_test {

using ::testing::HasSubstr;
using testing::short_scenario;

class ReadComparison : public ::testing::Test {
 protected:
  ReadComparison() {
    std::string name = ::testing::TempDir() + "read_comparison_XXXXXX";
    folder_ = ::mkdtemp(name.data());
    ComparisonOptions options;
    options.plants = {"analytic", "mujoco_car"};
    options.episodes = 3;
    options.paths = 60;
    written_ =
        *compare_plants(testing::short_scenario({"model_error.rms=[0.02, 0.02, 0.01]"}), options);
    write_comparison(written_, {}, folder_);
  }
  ~ReadComparison() override { std::filesystem::remove_all(folder_); }

  /// The error message for the file; empty if it is read.
  [[nodiscard]] std::string refusal() const {
    try {
      (void)read_comparison(folder_);
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  }

  std::string folder_;
  Comparison written_;
};

// A controller without a plan is compared for the next step only.
TEST_F(ReadComparison, takes_what_any_controller_decides) {
  for (const controller::ControllerEntry& entry : controller::controllers()) {
    for (const char* about : {"path", "target"}) {
      std::vector<std::string> overrides = {"controller.kind=" + entry.name};
      if (entry.name == "lqr") {
        overrides.push_back(std::string("controller.lqr={about: ") + about + "}");
      }
      SCOPED_TRACE(entry.name + ", " + about);
      ComparisonOptions options;
      options.plants = {"analytic"};
      options.episodes = 2;
      options.paths = 40;
      const Comparison written = *compare_plants(short_scenario(overrides), options);
      write_comparison(written, {}, folder_);
      const Comparison read = read_comparison(folder_);
      const int stages = certified_stages(decision_parts(read.scenario));
      ASSERT_EQ(std::ssize(read.plants[0].horizon), stages);
      ASSERT_EQ(std::ssize(read.in_force()), stages);
      EXPECT_EQ(read.in_force().back().value, written.in_force().back().value);
      EXPECT_EQ(read.plants[0].horizon.back().w2, written.plants[0].horizon.back().w2);
    }
  }
}

TEST_F(ReadComparison, gives_back_what_was_written) {
  const Comparison read = read_comparison(folder_);
  EXPECT_EQ(read.scenario_text, written_.scenario_text);
  EXPECT_EQ(read.scenario.name, written_.scenario.name);
  EXPECT_EQ(read.paths, 60);
  EXPECT_EQ(read.w2_paths, written_.w2_paths);
  EXPECT_EQ(read.floors[2].deviation, written_.floors[2].deviation);
  ASSERT_TRUE(read.with_error);
  EXPECT_EQ((*read.with_error)[1].value, (*written_.with_error)[1].value);
  ASSERT_EQ(read.plants.size(), 2U);
  const PlantComparison& car = read.plants[1];
  const PlantComparison& own = written_.plants[1];
  EXPECT_EQ(car.name, "mujoco_car");
  EXPECT_EQ(car.speed, own.speed);
  EXPECT_EQ(car.episodes[2].certified, own.episodes[2].certified);
  EXPECT_EQ(car.episodes[2].unsafe_next, own.episodes[2].unsafe_next);
  EXPECT_EQ(car.closed_loop.outcomes, own.closed_loop.outcomes);
  EXPECT_EQ(car.closed_loop.p_value, own.closed_loop.p_value);
  EXPECT_EQ(car.closed_loop.cost_deviation, own.closed_loop.cost_deviation);
  EXPECT_EQ(car.one_step.covariance, own.one_step.covariance);
  EXPECT_EQ(car.one_step.periods, own.one_step.periods);
  EXPECT_EQ(car.one_step.whiteness.p_value, own.one_step.whiteness.p_value);
  ASSERT_EQ(car.horizon.size(), own.horizon.size());
  EXPECT_EQ(car.horizon[2].divergence_rmse, own.horizon[2].divergence_rmse);
  EXPECT_EQ(car.horizon[2].w2, own.horizon[2].w2);
  EXPECT_EQ(car.horizon[2].unsafe_limits.upper, own.horizon[2].unsafe_limits.upper);
  EXPECT_EQ(car.exceeded_stages, own.exceeded_stages);
}

TEST_F(ReadComparison, refuses_a_file_of_a_newer_schema_or_of_something_else) {
  const std::string path = folder_ + "/" + kComparisonFile;
  {
    Hdf5File file = Hdf5File::create(path);
    file.set_text("/", "kind", "comparison");
    file.set_integer("/", "schema", kComparisonSchema + 1);
    file.close();
  }
  EXPECT_THAT(refusal(), HasSubstr("comparison.h5: /@schema: found schema 2"));
  {
    Hdf5File file = Hdf5File::create(path);
    file.set_integer("/", "schema", kComparisonSchema);
    file.close();
  }
  EXPECT_THAT(refusal(), HasSubstr("/@kind"));
  std::filesystem::remove(path);
  EXPECT_THAT(refusal(), HasSubstr("comparison.h5"));
}

TEST_F(ReadComparison, refuses_a_damaged_file_and_one_that_is_cut_short) {
  const std::string path = folder_ + "/" + kComparisonFile;
  const auto size = std::filesystem::file_size(path);
  for (const auto share : {0.0, 0.1, 0.5, 0.95}) {
    const std::string kept = folder_ + "/whole.h5";
    std::filesystem::copy_file(path, kept, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(path,
                                 static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    EXPECT_THAT(refusal(), HasSubstr("comparison.h5")) << share;
    std::filesystem::rename(kept, path);
  }
  EXPECT_EQ(refusal(), "");
}

/// A file as the previous version wrote it, except for its paths.
TEST_F(ReadComparison, an_older_file_has_no_speed_and_no_p_values_but_its_sums) {
  const std::string path = folder_ + "/" + kComparisonFile;
  const Hdf5File source = Hdf5File::open(path);
  const std::string older = folder_ + "/older";
  make_output_folder(older);
  Hdf5File file = Hdf5File::create(older + "/" + kComparisonFile);
  for (const char* name : {"kind", "version", "scenario"}) {
    file.set_text("/", name, source.text("/", name));
  }
  file.set_integer("/", "schema", source.integer("/", "schema"));
  for (const char* name : {"names", "groups"}) {
    file.create_group("/plants");
    file.set_texts("/plants", name, source.texts("/plants", name));
  }
  for (const DatasetSpec& spec : comparison_layout(written_)) {
    if (spec.path.starts_with("/timing") || spec.path.find("/next_step/") != std::string::npos) {
      continue;
    }
    file.create_dataset(spec);
    if (spec.type == DatasetSpec::Type::kText) file.append(spec.path, source.texts(spec.path));
    if (spec.type == DatasetSpec::Type::kInt64) file.append(spec.path, source.integers(spec.path));
    if (spec.type == DatasetSpec::Type::kFloat64) file.append(spec.path, source.doubles(spec.path));
  }
  for (const std::string& group : plant_groups(written_)) {
    file.set_integer(group + "/paths", "faults", 0);
  }
  file.close();
  const Comparison read = read_comparison(older);
  const ClosedLoop& loop = read.plants[1].closed_loop;
  EXPECT_TRUE(std::isnan(read.plants[1].speed));
  EXPECT_TRUE(std::isnan(loop.p_value));
  EXPECT_EQ(loop.periods, written_.plants[1].closed_loop.periods);
  EXPECT_EQ(loop.unsafe_periods, written_.plants[1].closed_loop.unsafe_periods);
  EXPECT_NEAR(loop.certified_periods, written_.plants[1].closed_loop.certified_periods, 1e-12);
  EXPECT_EQ(loop.cost, written_.plants[1].closed_loop.cost);
}

}  // namespace comparison_reader_test
}  // namespace qsmpc::harness
