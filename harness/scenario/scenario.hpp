// One experiment as plain values: what a scenario file says, checked and with defaults filled in.
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
    std::string system;               ///< a name from `qsmpc list systems`, or the own system's
    models::ParameterMap parameters;  ///< all of them, defaults filled in
    /// A system of the user's: by equations, or as its library describes it.
    std::optional<models::EquationSystem> own{};
    std::string library{};  ///< absolute path of the shared library that it is from
  };
  struct Plant {
    std::string kind = "mujoco";  ///< a name from `qsmpc list plants`: "analytic" or "mujoco"
    std::string mjcf;             ///< absolute path of the XML; also drawn for an analytic plant
    std::optional<double> time_step{};  ///< the simulator's, s; else the one in the XML
    /// How the system appears in the MuJoCo model; else what the XML says of itself.
    std::optional<PlantMapping> mapping{};
    bool solid = false;  ///< whether walls and obstacles stand in the way of the MuJoCo vehicle
  };
  struct GaussianValue {
    Eigen::VectorXd mean;        ///< state_dim
    Eigen::MatrixXd covariance;  ///< state_dim x state_dim
  };
  struct Disturbance {
    Eigen::MatrixXd covariance;  ///< of the noise in the model, state_dim x state_dim, per period
    Eigen::MatrixXd sensor{};    ///< of what the planner sees less the state, state_dim x state_dim
    std::string kind = "state";  ///< how the plant gets it: "state" or "force"
    /// Deviations of the logarithms of what is drawn once an episode, see PlantVariation.
    double friction = 0.0;
    double mass = 0.0;
    double wheelbase = 0.0;
    /// From these periods on, noise and measurement noise are drawn by other seeds; ascending.
    std::vector<models::NoiseSeed> seeds{};
  };
  /// What a model error was measured of, as far as that is known. It holds for nothing else.
  struct ErrorOrigin {
    models::ParameterMap parameters;    ///< of the model; empty: not known
    std::optional<double> time_step{};  ///< s, the control period
    Plant plant{};                      ///< its kind empty: not known; of its file the name
    std::string digest{};               ///< of that file, by plant_digest; empty: not known
    std::string disturbance_kind{};     ///< empty: not known
    std::optional<double> friction{};   ///< deviations of logarithms, as in Disturbance
    std::optional<double> mass{};
    std::optional<double> wheelbase{};
  };
  struct Target {
    Eigen::VectorXd state;      ///< state_dim; with a path or waypoints, at the end
    double radius = 0.5;        ///< m, in the plane of position (or over all states without one)
    std::vector<int> angles{};  ///< indices of states whose target is meant modulo 2π
    TargetPath path{};          ///< without a row: none
    /// What controllers follow, where there is a path.
    std::optional<controller::PathTarget> course{};
    /// As they are written, [x, y] or state_dim numbers each; without one: none.
    std::vector<Eigen::VectorXd> waypoints{};
    /// What is driven to in turn, where there are waypoints.
    std::optional<controller::Waypoints> route{};

    [[nodiscard]] bool has_path() const { return path.rows.rows() > 0; }
    [[nodiscard]] bool has_waypoints() const { return !waypoints.empty(); }
  };
  struct Quantisation {
    int state = 100;                    ///< points of the belief
    int noise = 100;                    ///< points of the process noise
    int compressed = 100;               ///< points kept after each step
    std::string quantiser = "product";  ///< of the belief; a name from `qsmpc list quantisers`
    /// Where above 0, the numbers of the belief and of those kept are chosen, and are at most
    /// these: what plans may then cost more, relative.
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
  /// Upper limits of certified probabilities, infinite for none.
  struct Risk {
    double stage = std::numeric_limits<double>::infinity();    ///< of each stage of a plan
    double plan = std::numeric_limits<double>::infinity();     ///< of any stage of a plan
    double mission = std::numeric_limits<double>::infinity();  ///< of the whole drive
    std::string otherwise = "least_risk";  ///< a fallback of risk_otherwise_entries()

    [[nodiscard]] bool any() const {
      return stage < std::numeric_limits<double>::infinity() ||
             plan < std::numeric_limits<double>::infinity() ||
             mission < std::numeric_limits<double>::infinity();
    }
  };
  struct Estimator {
    /// A name from `qsmpc list estimators`; unless given, "exact" without measurement noise and
    /// else "last_measurement".
    std::string kind = "exact";
  };
  /// A controller that is no part of the program: kinds "external" and "library".
  struct OutsideController {
    std::vector<std::string> command;  ///< of "external": the program and its arguments
    std::string folder;                ///< of "external", absolute: where the process works
    std::string library;               ///< of "library": absolute path of the shared library
    std::string options = "{}";        ///< for the controller, as one JSON object
    bool plans = false;                ///< whether it answers a plan of `horizon` stages, too
    double start_deadline = 60.0;      ///< s, from its start until it is ready
  };
  struct Shield {
    std::string of = "nominal";  ///< the controller that is shielded
    double limit = 0.02;         ///< of the certificate of the stages that it looks ahead
    int stages = 0;              ///< how many; 0: the whole horizon
  };
  struct Controller {
    std::string kind = "quantised";  ///< a name from `qsmpc list controllers`
    std::string lqr_about = "path";  ///< or "target": about what "lqr" linearises
    controller::MppiSettings mppi;   ///< of "mppi" and "risk_mppi"
    OutsideController outside;
    int horizon = 8;
    controller::ChanceSettings chance;  ///< of controllers that keep a chance constraint …
    int disturbance_memory = 8;         ///< … and their memory under "disturbance_feedback"
    Shield shield;
    std::string policy = "closed_loop";            ///< or "open_loop", "disturbance_feedback"
    std::string guide = "none";                    ///< or "grid": what plans aim along
    std::optional<Eigen::MatrixXd> feedback_gain;  ///< K, input_dim x state_dim; else from LQR
    /// Weight of the input in that LQR, relative to the cost's; 0 where it is not given: 1, and
    /// with limits of the risk what the planner finds best.
    double feedback_effort = 0.0;
    /// Whether a matrix that is added to the gains of all stages is optimised along with the
    /// inputs.
    bool optimise_gain = false;
    std::string solver = "lbfgs";            ///< a name from `qsmpc list solvers`
    std::string input_bounding = "bounded";  ///< a name from `qsmpc list boundings`
    Quantisation quantisation;
    bool propagate_noise = true;
    /// How, in the prediction; a name from `qsmpc list propagators`. The default without noise.
    std::string propagator = "mixture";
    Cost cost;
    Penalty penalty;
    Eigen::VectorXd input_lower;  ///< input_dim
    Eigen::VectorXd input_upper;  ///< input_dim
    int max_iterations = 100;
    double deadline = std::numeric_limits<double>::infinity();  ///< of one plan, s
    int threads = 1;  ///< that loops over many particles are divided among
  };
  struct Video {
    std::string camera = "chase";  ///< "chase", "top", "fixed" or "split"
    int width = 1280;              ///< pixels
    int height = 720;              ///< pixels
    int fps = 30;                  ///< frames a second
    /// Names from `overlay_names`, each once.
    std::vector<std::string> overlays{"particles", "ellipses", "tube", "ghost", "body", "path"};
  };

  std::string name;
  std::string description;
  Model model;
  Plant plant;
  double time_step = 0.1;  ///< s, the control period
  GaussianValue initial_state;
  Disturbance disturbance;
  /// How far the plant is from the model, where that is known: certificates then hold for it.
  std::optional<controller::ModelError> model_error;
  std::optional<ErrorOrigin> error_origin{};  ///< where that says it
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
