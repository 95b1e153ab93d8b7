#include "controller/planning/belief_quantiser.hpp"

#include <stdexcept>
#include <string>

namespace qsmpc::controller {
namespace {

// Builds the message only on failure, so that a control loop allocates nothing.
void require_belief(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("belief: ") + message);
}

}  // namespace

void BeliefQuantiser::quantise(const Gaussian& belief, GaussianQuantisation& out) {
  require_belief(belief.mean.size() == dim_, "the mean must have the state's dimension");
  require_belief(belief.mean.allFinite(), "the mean must be finite");
  require_belief(belief.covariance.rows() == dim_ && belief.covariance.cols() == dim_ &&
                     belief.covariance.allFinite(),
                 "the covariance must be a finite matrix of states x states");
  if (covariance_.size() == 0 || covariance_ != belief.covariance) {
    const Gaussian centred{.mean = Eigen::VectorXd::Zero(dim_), .covariance = belief.covariance};
    centred_ = controller::quantise(centred, budget_, kind_);
    covariance_ = belief.covariance;
  }
  out = centred_;
  out.measure.locations.colwise() += belief.mean;
}

}  // namespace qsmpc::controller
