#include "harness/mujoco/newer_mjcf.hpp"

#include <array>
#include <regex>
#include <string_view>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

namespace qsmpc::harness {
namespace {

struct NewerName {
  std::string_view name;
  std::string_view version;  ///< that introduced it
  std::string_view instead;  ///< the replacement
};

constexpr std::string_view kLeftOut = "leave it out";
constexpr std::string_view kDrawing = "leave it out: it only affects drawing";
constexpr std::string_view kForceRange = "give the actuators of the joint a forcerange";
constexpr std::string_view kDeformable = "leave it out, or use a composite";

constexpr std::array kValues{
    NewerName{"implicitfast", "2.3.3", "write implicit"},
    NewerName{"filterexact", "3.0.0", "write filter"},
    NewerName{"sdf", "3.0.0", "write a mesh or a primitive"},
};

constexpr std::array kElements{
    NewerName{"frame", "3.1.0", "write a body without joints"},
    NewerName{"replicate", "3.1.5", "write each copy out"},
    NewerName{"attach", "3.2.0", "write the attached bodies out, or include them"},
    NewerName{"deformable", "3.0.0", kDeformable},
    NewerName{"flexcomp", "3.0.0", kDeformable},
    NewerName{"flex", "3.0.0", kDeformable},
    NewerName{"extension", "2.3.0", kLeftOut},
    NewerName{"plugin", "2.3.0", kLeftOut},
    NewerName{"camprojection", "3.0.0", kLeftOut},
    NewerName{"jointactuatorfrc", "2.3.7", "write an actuatorfrc sensor for each actuator"},
    NewerName{"tendonactuatorfrc", "3.3.1", "write an actuatorfrc sensor for each actuator"},
    NewerName{"e_potential", "3.3.0", kLeftOut},
    NewerName{"e_kinetic", "3.3.0", kLeftOut},
    NewerName{"layer", "3.2.5", kDrawing},
    NewerName{"distance", "3.1.6", kLeftOut},
    NewerName{"normal", "3.1.6", kLeftOut},
    NewerName{"fromto", "3.1.6", kLeftOut},
};

constexpr std::array kAttributes{
    NewerName{"actuatorfrcrange", "3.0.0", kForceRange},
    NewerName{"actuatorfrclimited", "3.0.0", kForceRange},
    NewerName{"actuatorforcerange", "2.3.7", kForceRange},
    NewerName{"actuatorforcelimited", "2.3.7", kForceRange},
    NewerName{"actuatorgravcomp", "3.1.4", kLeftOut},
    NewerName{"actuatorgroupdisable", "3.0.1", "leave the disabled actuators out"},
    NewerName{"gravcomp", "2.3.1", "leave it out, or set the option gravity"},
    NewerName{"actdim", "2.3.1", kLeftOut},
    NewerName{"actearly", "3.0.0", kLeftOut},
    NewerName{"kv", "3.1.0",
              "write damping at the joint, or a general actuator with biasprm=\"0 -kp -kv\""},
    NewerName{"dampratio", "3.1.6",
              "write damping at the joint, or a general actuator with biasprm=\"0 -kp -kv\""},
    NewerName{"timeconst", "3.1.6", "write a general actuator with dyntype=\"filter\""},
    NewerName{"inheritrange", "3.1.3", "write the ctrlrange explicitly"},
    NewerName{"eulerdamp", "3.0.0",
              "leave it out: Euler always integrates the damping of joints implicitly"},
    NewerName{"invdiscrete", "3.0.0", kLeftOut},
    NewerName{"island", "3.0.0", kLeftOut},
    NewerName{"nativeccd", "3.2.3", kLeftOut},
    NewerName{"autoreset", "3.2.1", kLeftOut},
    NewerName{"ls_iterations", "3.0.0", kLeftOut},
    NewerName{"ls_tolerance", "3.0.0", kLeftOut},
    NewerName{"ccd_iterations", "3.2.3", "write mpr_iterations"},
    NewerName{"ccd_tolerance", "3.2.3", "write mpr_tolerance"},
    NewerName{"solreffriction", "2.3.6", kLeftOut},
    NewerName{"tausmooth", "2.3.6", kLeftOut},
    NewerName{"align", "3.2.3", kLeftOut},
    NewerName{"alignfree", "3.2.3", kLeftOut},
    NewerName{"maxhullvert", "3.2.0", kLeftOut},
    NewerName{"elevation", "3.1.2", "give the height field as a PNG file"},
    NewerName{"assetdir", "2.3.0", "write meshdir and texturedir"},
    NewerName{"content_type", "2.3.7", "leave it out: the file name extension decides"},
    NewerName{"realtime", "2.3.0", kDrawing},
    NewerName{"ellipsoidinertia", "2.3.4", kDrawing},
    NewerName{"bvactive", "3.1.2", kDrawing},
    NewerName{"bulbradius", "3.1.5", kDrawing},
    NewerName{"metallic", "3.1.5", kDrawing},
    NewerName{"roughness", "3.1.5", kDrawing},
    NewerName{"orthographic", "3.2.0", kDrawing},
    NewerName{"resolution", "3.0.0", kDrawing},
    NewerName{"focal", "3.0.0", kDrawing},
    NewerName{"focalpixel", "3.0.0", kDrawing},
    NewerName{"principal", "3.0.0", kDrawing},
    NewerName{"principalpixel", "3.0.0", kDrawing},
    NewerName{"sensorsize", "3.0.0", kDrawing},
};

template <class Table>
std::string hint_in(const Table& table, const std::string& complaint, const char* pattern) {
  std::smatch match;
  if (!std::regex_search(complaint, match, std::regex(pattern))) return "";
  for (const NewerName& newer : table) {
    if (match[1].str() != newer.name) continue;
    return fmt::format("a model for MuJoCo {}: {} was introduced in {}; {}", mujoco_version(),
                       newer.name, newer.version, newer.instead);
  }
  return "";
}

}  // namespace

std::string mujoco_version() { return mj_versionString(); }

std::string newer_mjcf_hint(const std::string& complaint) {
  for (const std::string& hint :
       {hint_in(kValues, complaint, "invalid keyword: '([^']*)'"),
        hint_in(kAttributes, complaint, "unrecognized attribute: '([^']*)'"),
        hint_in(kElements, complaint, R"(unrecognized element\s+Element '([^']*)')")}) {
    if (!hint.empty()) return hint;
  }
  // MuJoCo's own message already states the replacement.
  if (std::regex_search(complaint, std::regex("has `\\w+` but not `\\w+`"))) {
    return fmt::format(
        "a model for MuJoCo {}: a range alone sets limits only since 3.0.0; write <compiler "
        "autolimits=\"true\"/>",
        mujoco_version());
  }
  return "";
}

}  // namespace qsmpc::harness
