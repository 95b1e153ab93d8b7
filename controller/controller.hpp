// All public headers of the controller: measures, plans, controllers and certificates. They require
// Eigen and the standard library.
//
//   auto car = qsmpc::models::make_dynamics("dubins", {{"speed", 1.5}}, 0.1);
//   auto controller = qsmpc::controller::make_controller("quantised", *car, settings);
//   const qsmpc::controller::Decision& decision = controller->decide(situation);
#pragma once

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/control/controller.hpp"
#include "controller/control/decision_motion.hpp"
#include "controller/laws/law_propagator.hpp"
#include "controller/measure/measures.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/measure/wasserstein.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/planning/points_choice.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "controller/surroundings/motion_filter.hpp"
#include "models/models.hpp"
