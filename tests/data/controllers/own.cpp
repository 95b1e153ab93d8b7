// A controller that steers straight ahead, and in period 2 behaves as options.mode says.
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "controller/control/own_controller.hpp"

namespace {

class Own {
 public:
  explicit Own(const qsmpc::own::Problem& problem)
      : options_(problem.raw.options), problem_(problem) {
    if (is("no_start")) throw std::runtime_error("no horizon of that many stages");
  }

  void reset(std::uint64_t seed) { seed_ = seed; }

  qsmpc::own::Answer act(const qsmpc::own::Situation& situation) {
    if (problem_.plans()) return plan();
    qsmpc::own::Answer answer;
    answer.input =
        Eigen::VectorXd::Constant(problem_.input_dim(), 0.01 * static_cast<double>(seed_ % 10));
    if (situation.period == 2) misbehave(answer.input);
    return answer;
  }

 private:
  [[nodiscard]] bool is(const std::string& mode) const {
    return options_.find("\"mode\":\"" + mode + "\"") != std::string::npos;
  }

  void misbehave(Eigen::VectorXd& input) const {
    if (is("crash")) *static_cast<volatile int*>(nullptr) = 1;
    while (is("hang")) std::this_thread::sleep_for(std::chrono::seconds(1000));
    if (is("nan")) input[0] = std::numeric_limits<double>::quiet_NaN();
    if (is("inf")) input[0] = std::numeric_limits<double>::infinity();
    if (is("size")) input.setZero(2);
    if (is("bounds")) input[0] = 99.0;
    if (is("error")) throw std::runtime_error("no way out");
    if (is("exit")) std::exit(7);
  }

  [[nodiscard]] qsmpc::own::Answer plan() const {
    const qsmpc::own::RowMajor gain = Eigen::RowVector3d(0.0, -0.5, -1.0);
    return {.plan_inputs = Eigen::MatrixXd::Constant(problem_.input_dim(), problem_.horizon(), 0.1),
            .plan_gains = std::vector(static_cast<std::size_t>(problem_.horizon()), gain),
            .status = "stalled",
            .evaluations = 3};
  }

  std::string options_;
  qsmpc::own::Problem problem_;
  std::uint64_t seed_ = 0;
};

}  // namespace

QSMPC_REGISTER_CONTROLLER(Own);
