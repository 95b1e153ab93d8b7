// One experiment as plain values: the content of a scenario file, checked and with defaults filled
// in.
//
// Keys and their meaning are documented in docs/scenario.md. A Scenario that was loaded is valid:
// sizes agree with the system, covariances are positive semidefinite, names are known.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/chance/chance_settings.hpp"
#include "controller/control/mppi/mppi_settings.hpp"
#include "controller/prediction/model_error.hpp"
#include "controller/reference/path_target.hpp"
#include "controller/reference/waypoints.hpp"
#include "controller/regions/safe_set.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "harness/scenario/target_path.hpp"
#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/equations/equation_system.hpp"
#include "models/random/noise_seeds.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::harness {

struct Scenario {
  struct Model {
    std::string system;               ///< a name from `qsmpc list systems`, or a user-defined one
    models::ParameterMap parameters;  ///< all of them, defaults filled in
    /// A user-defined system: from equations, or as its library describes it.
    std::optional<models::EquationSystem> own{};
    std::string library{};  ///< absolute path of the system's shared library
  };
  struct Plant {
    std::string kind = "mujoco";  ///< a name from `qsmpc list plants`: "analytic" or "mujoco"
    std::string mjcf;             ///< absolute path of the XML; also used to draw an analytic plant
    std::optional<double> time_step{};  ///< the simulator's, s; else that of the XML
    /// How the system appears in the MuJoCo model; else the mapping in the XML.
    std::optional<PlantMapping> mapping{};
    bool solid = false;  ///< whether the MuJoCo vehicle collides with walls and obstacles
  };
  struct GaussianValue {
    Eigen::VectorXd mean;        ///< state_dim
    Eigen::MatrixXd covariance;  ///< state_dim x state_dim
  };
  struct Disturbance {
    Eigen::MatrixXd covariance;  ///< of the model's noise per period, state_dim x state_dim
    Eigen::MatrixXd sensor{};    ///< of the measurement noise, state_dim x state_dim
    std::string kind = "state";  ///< how it acts on the plant: "state" or "force"
    /// Standard deviations of the logarithms of the factors drawn once per episode, see
    /// PlantVariation.
    double friction = 0.0;
    double mass = 0.0;
    double wheelbase = 0.0;
    /// Noise and measurement noise are drawn with these seeds from these periods on; ascending.
    std::vector<models::NoiseSeed> seeds{};
  };
  /// The origin of a model error, as far as it is known. The error is valid for nothing else.
  struct ErrorOrigin {
    models::ParameterMap parameters;    ///< of the model; empty: not known
    std::optional<double> time_step{};  ///< s, the control period
    Plant plant{};                      ///< empty kind: not known; of its file only the name
    std::string digest{};               ///< of the plant's file, by plant_digest; empty: not known
    std::string disturbance_kind{};     ///< empty: not known
    std::optional<double> friction{};   ///< standard deviations of logarithms, as in Disturbance
    std::optional<double> mass{};
    std::optional<double> wheelbase{};
  };
  struct Target {
    Eigen::VectorXd state;      ///< state_dim; with a path or waypoints, the final one
    double radius = 0.5;        ///< m, in the plane of position (or over all states without one)
    std::vector<int> angles{};  ///< indices of the states whose target is modulo 2π
    TargetPath path{};          ///< no rows: no path
    /// The path as controllers follow it, where there is one.
    std::optional<controller::PathTarget> course{};
    /// As written, [x, y] or state_dim numbers each; empty: no waypoints.
    std::vector<Eigen::VectorXd> waypoints{};
    /// The waypoints as controllers drive to them in turn, where there are any.
    std::optional<controller::Waypoints> route{};

    [[nodiscard]] bool has_path() const { return path.rows.rows() > 0; }
    [[nodiscard]] bool has_waypoints() const { return !waypoints.empty(); }
  };
  struct Quantisation {
    int state = 100;                    ///< points of the belief
    int noise = 100;                    ///< points of the process noise
    int compressed = 100;               ///< points kept after each step
    std::string quantiser = "product";  ///< of the belief; a name from `qsmpc list quantisers`
    /// If above 0, the numbers of points `state` and `compressed` are chosen automatically, with
    /// the values above as upper limits: the relative increase in a plan's cost that this may
    /// cause.
    double tolerance = 0.0;
  };
  struct Cost {
    Eigen::MatrixXd state;     ///< Q, state_dim x state_dim
    Eigen::MatrixXd input;     ///< R, input_dim x input_dim
    Eigen::MatrixXd terminal;  ///< Q_term, state_dim x state_dim
  };
  struct Penalty {
    std::string shape = "smooth";  ///< "smooth" or "thesis" (Algorithm 2)
    double box = 450.0;            ///< weight
    double obstacle = 400.0;       ///< weight
    double length = 0.5;           ///< m, how far outside the unsafe set the smooth shape begins
  };
  /// Upper limits of certified probabilities of being unsafe; infinite: no limit.
  struct Risk {
    double stage = std::numeric_limits<double>::infinity();    ///< at each stage of a plan
    double plan = std::numeric_limits<double>::infinity();     ///< at any stage of a plan
    double mission = std::numeric_limits<double>::infinity();  ///< over the whole drive
    /// Share of the limits `stage` and `plan` that plans leave to later ones where they can.
    double reserve = 0.75;
    std::string otherwise = "least_risk";  ///< a fallback of risk_otherwise_entries()

    [[nodiscard]] bool any() const {
      return stage < std::numeric_limits<double>::infinity() ||
             plan < std::numeric_limits<double>::infinity() ||
             mission < std::numeric_limits<double>::infinity();
    }
  };
  struct Estimator {
    /// A name from `qsmpc list estimators`; the default is "exact" without measurement noise and
    /// "last_measurement" with it.
    std::string kind = "exact";
  };
  /// A controller outside the program: kinds "external" and "library".
  struct OutsideController {
    std::vector<std::string> command;  ///< of "external": the program and its arguments
    std::string folder;                ///< of "external", absolute: the process's working folder
    std::string library;               ///< of "library": absolute path of the shared library
    std::string options = "{}";        ///< passed to the controller, as one JSON object
    bool plans = false;                ///< whether its answers include a plan of `horizon` stages
    double start_deadline = 60.0;      ///< s, from start to ready
  };
  struct Shield {
    std::string of = "nominal";  ///< the controller that is shielded
    double limit = 0.02;         ///< of the certificate over the stages that it looks ahead
    int stages = 0;              ///< number of stages; 0: the whole horizon
  };
  struct Controller {
    std::string kind = "quantised";  ///< a name from `qsmpc list controllers`
    std::string lqr_about = "path";  ///< linearisation point of "lqr", or "target"
    controller::MppiSettings mppi;   ///< of "mppi" and "risk_mppi"
    OutsideController outside;
    int horizon = 8;
    controller::ChanceSettings chance;  ///< of the controllers with a chance constraint …
    int disturbance_memory = 8;         ///< … and their memory under "disturbance_feedback"
    Shield shield;
    std::string policy = "closed_loop";            ///< or "open_loop", "disturbance_feedback"
    std::string guide = "none";                    ///< or "grid": the guide of plans
    std::optional<Eigen::MatrixXd> feedback_gain;  ///< K, input_dim x state_dim; else from LQR
    /// Weight of the input in that LQR, relative to the cost's; 0: not given, which means 1, or the
    /// planner's best choice with risk limits.
    double feedback_effort = 0.0;
    /// Whether a common offset of the gains of all stages is optimised along with the inputs.
    bool optimise_gain = false;
    std::string solver = "lbfgs";            ///< a name from `qsmpc list solvers`
    std::string input_bounding = "bounded";  ///< a name from `qsmpc list boundings`
    Quantisation quantisation;
    bool propagate_noise = true;
    /// How the prediction propagates noise; a name from `qsmpc list propagators`. Without noise,
    /// always the default.
    std::string propagator = "mixture";
    Cost cost;
    Penalty penalty;
    Eigen::VectorXd input_lower;  ///< input_dim
    Eigen::VectorXd input_upper;  ///< input_dim
    int max_iterations = 100;
    double deadline = std::numeric_limits<double>::infinity();  ///< of one plan, s
    int threads = 1;                                            ///< for loops over many particles
  };
  struct Video {
    std::string camera = "chase";  ///< "chase", "top", "fixed" or "split"
    int width = 1280;              ///< pixels
    int height = 720;              ///< pixels
    int fps = 30;                  ///< frames per second
    /// Distinct names from `overlay_names`.
    std::vector<std::string> overlays{"particles", "ellipses", "tube", "ghost", "body", "path"};
  };

  std::string name;
  std::string description;
  Model model;
  Plant plant;
  double time_step = 0.1;  ///< s, the control period
  GaussianValue initial_state;
  Disturbance disturbance;
  /// Bounds on the difference between plant and model, where known: certificates then hold for the
  /// plant.
  std::optional<controller::ModelError> model_error;
  std::optional<ErrorOrigin> error_origin{};  ///< of the model error, if stated
  controller::SafeSet safe_set;
  Target target;
  Risk risk;
  Estimator estimator;
  Controller controller;
  int step_limit = 200;
  bool stop_when_unsafe = true;  ///< whether the episode ends when the true state is unsafe
  std::uint64_t seed = 0;
  Video video;
};

}  // namespace qsmpc::harness

#pragma GCC visibility pop
