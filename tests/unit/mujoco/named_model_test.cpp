#include "harness/mujoco/named_model.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::harness {
namespace named_model_test {

using ::testing::HasSubstr;

// An axle without its own shape: its wheels are bodies fixed to it; a hub cap for display only and
// a gear with its own hinge are larger.
constexpr const char* kAxle = R"(<mujoco><worldbody><body>
  <freejoint/><geom size="1"/>
  <body name="axle"><joint name="axle" axis="0 1 0"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    <body pos="0 0.5 0"><body>
      <geom type="cylinder" size="0.3 0.1"/>
      <geom type="sphere" size="0.7" contype="0" conaffinity="0"/>
    </body></body>
    <body pos="0 -0.5 0"><geom type="cylinder" size="0.25 0.1"/></body>
    <body><joint name="gear" axis="0 1 0"/><geom type="cylinder" size="0.9 0.1"/></body>
  </body>
  <body><joint name="flap"/><geom type="box" size="0.1 0.1 0.1"/></body>
</body></worldbody></mujoco>
)";

class WheelRadiusTest : public ::testing::Test {
 protected:
  double radius(const std::string& joint) const {
    const NamedModel named{.model = *model_, .file = "axle.xml"};
    return wheel_radius(named, scalar_joint(named, joint));
  }

 private:
  testing::TemporaryFolder folder_;
  MujocoModelPtr model_ = load_mujoco_model(folder_.file("axle.xml", kAxle));
};

TEST_F(WheelRadiusTest, is_that_of_the_largest_wheel_that_turns_with_the_joint) {
  EXPECT_EQ(radius("axle"), 0.3);
  EXPECT_EQ(radius("gear"), 0.9);
}

TEST_F(WheelRadiusTest, is_refused_where_nothing_round_turns) {
  try {
    (void)radius("flap");
    FAIL() << "it has a radius";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().key, "joint flap");
    EXPECT_THAT(error.where().found, HasSubstr("no wheel"));
  }
}

}  // namespace named_model_test
}  // namespace qsmpc::harness
