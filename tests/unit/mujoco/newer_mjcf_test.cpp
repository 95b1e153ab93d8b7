#include "harness/mujoco/newer_mjcf.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace newer_mjcf_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What is inserted into a model of a body on a slide.
struct Model {
  const char* option = "";
  const char* joint = "";
  const char* rest = "";
  const char* world = "";
};

InputError::Where refusal(const Model& model) {
  const testing::TemporaryFolder folder;
  const std::string file = folder.file(
      "car.xml", std::string("<mujoco><option ") + model.option + "/><worldbody>" + model.world +
                     "<body><joint name=\"slide\" type=\"slide\" " + model.joint +
                     "/><geom size=\"1\"/></body></worldbody>" + model.rest + "</mujoco>");
  try {
    (void)load_mujoco_model(file);
  } catch (const InputError& error) {
    return error.where();
  }
  ADD_FAILURE() << "it loads";
  return {};
}

TEST(NewerMjcf, names_the_version_of_a_value_and_what_to_write_instead) {
  const auto where = refusal({.option = "integrator=\"implicitfast\""});
  EXPECT_THAT(where.found, HasSubstr("implicitfast"));
  EXPECT_THAT(where.expected, AllOf(HasSubstr("MuJoCo " + mujoco_version()),
                                    HasSubstr("implicitfast was introduced in 2.3.3"),
                                    HasSubstr("write implicit")));
}

TEST(NewerMjcf, names_the_version_of_an_attribute) {
  EXPECT_THAT(
      refusal({.joint = "actuatorfrcrange=\"-1 1\""}).expected,
      AllOf(HasSubstr("actuatorfrcrange was introduced in 3.0.0"), HasSubstr("forcerange")));
  EXPECT_THAT(
      refusal({.rest = "<actuator><position joint=\"slide\" kv=\"2\"/></actuator>"}).expected,
      AllOf(HasSubstr("kv was introduced in 3.1.0"), HasSubstr("damping at the joint")));
}

TEST(NewerMjcf, names_the_version_of_an_element) {
  EXPECT_THAT(refusal({.rest = "<sensor><jointactuatorfrc joint=\"slide\"/></sensor>"}).expected,
              AllOf(HasSubstr("jointactuatorfrc was introduced in 2.3.7"),
                    HasSubstr("actuatorfrc sensor")));
  EXPECT_THAT(refusal({.world = "<frame/>"}).expected, HasSubstr("frame was introduced in 3.1.0"));
}

TEST(NewerMjcf, says_that_a_range_alone_does_not_limit_yet) {
  EXPECT_THAT(refusal({.joint = "range=\"-1 1\""}).expected,
              AllOf(HasSubstr("3.0.0"), HasSubstr("autolimits=\"true\"")));
}

TEST(NewerMjcf, a_misspelt_name_is_of_no_version) {
  EXPECT_THAT(refusal({.joint = "dampling=\"1\""}).expected,
              AllOf(HasSubstr("MuJoCo " + mujoco_version()), Not(HasSubstr("was introduced in"))));
}

}  // namespace newer_mjcf_test
}  // namespace qsmpc::harness
