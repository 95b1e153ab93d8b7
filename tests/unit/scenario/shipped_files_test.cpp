#include "harness/scenario/shipped_files.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace shipped_files_test {

// Sets QSMPC_MODELS during its lifetime.
class ModelsVariable {
 public:
  explicit ModelsVariable(const std::string& value) {
    ::setenv("QSMPC_MODELS", value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  }
  ModelsVariable(const ModelsVariable&) = delete;
  ModelsVariable& operator=(const ModelsVariable&) = delete;
  ModelsVariable(ModelsVariable&&) = delete;
  ModelsVariable& operator=(ModelsVariable&&) = delete;
  ~ModelsVariable() { ::unsetenv("QSMPC_MODELS"); }  // NOLINT(concurrency-mt-unsafe)
};

TEST(ShippedFiles, are_the_source_trees_when_the_program_is_not_installed) {
  EXPECT_TRUE(std::filesystem::equivalent(shipped_models_folder(),
                                          std::string(QSMPC_SOURCE_DIR) + "/models"));
}

TEST(ShippedFiles, are_looked_up_in_the_environments_folder_first) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scenarios");
  (void)folder.file("scenarios/own.yaml", minimal_text + "description: mine\n");
  (void)folder.file("scenarios/broken.yaml", "a: [\n");
  (void)folder.file("scenarios/notes.txt", "");
  const ModelsVariable variable(folder.path());
  const std::vector<ShippedScenario> shipped = shipped_scenarios();
  ASSERT_EQ(shipped.size(), 2U);
  EXPECT_EQ(shipped[0].name, "broken");
  EXPECT_EQ(shipped[0].description, "");
  EXPECT_EQ(shipped[1].name, "own");
  EXPECT_EQ(shipped[1].description, "mine");
  EXPECT_EQ(load_scenario("own").description, "mine");
}

TEST(ShippedFiles, none_are_listed_where_the_folder_is_missing) {
  const ModelsVariable variable("/no/such/folder");
  EXPECT_TRUE(shipped_scenarios().empty());
  EXPECT_FALSE(find_shipped_scenario("dubins_obstacles").has_value());
}

TEST(FindMjcf, prefers_the_scenarios_folder_to_the_shipped_files) {
  const TemporaryFolder folder;
  const TemporaryFolder models;
  std::filesystem::create_directories(models / "mjcf");
  const std::string shipped = models.file("mjcf/car.xml", "<mujoco/>");
  const ModelsVariable variable(models.path());
  EXPECT_TRUE(std::filesystem::equivalent(find_mjcf("car.xml", folder.path()), shipped));
  const std::string own = folder.file("car.xml", "<mujoco/>");
  EXPECT_TRUE(std::filesystem::equivalent(find_mjcf("car.xml", folder.path()), own));
  EXPECT_TRUE(std::filesystem::equivalent(find_mjcf(own, "/"), own));
  EXPECT_EQ(find_mjcf("none.xml", folder.path()), "");
  EXPECT_EQ(find_mjcf("/none.xml", folder.path()), "");
  EXPECT_EQ(find_mjcf("", folder.path()), "");
  EXPECT_EQ(find_mjcf(".", folder.path()), "");
}

TEST(FindMjcf, a_shipped_file_is_named_without_the_path_of_this_machine) {
  const TemporaryFolder models;
  std::filesystem::create_directories(models / "mjcf");
  const std::string shipped = models.file("mjcf/car.xml", "<mujoco/>");
  const ModelsVariable variable(models.path());
  EXPECT_EQ(mjcf_name(find_mjcf("car.xml", "")), "car.xml");
  EXPECT_EQ(mjcf_name(models / "scenarios/../mjcf/car.xml"), "car.xml");
  EXPECT_EQ(mjcf_name("/elsewhere/car.xml"), "/elsewhere/car.xml");
  EXPECT_EQ(mjcf_name(""), "");
}

}  // namespace shipped_files_test
}  // namespace qsmpc::harness
