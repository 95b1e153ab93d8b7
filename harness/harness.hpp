// All of the public headers of the harness: scenarios, episodes, traces and their videos.
//
//   using namespace qsmpc::harness;
//   const Scenario scenario = load_scenario("dubins_obstacles", {"controller.horizon=12"});
//   const Trace trace = run_episode(scenario, {.seed = 1});
//   write_trace("episode.h5", trace);
#pragma once

#include "controller/controller.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/assembly/chosen_points.hpp"
#include "harness/assembly/first_decision.hpp"
#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/summary.hpp"
#include "harness/trace/trace.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/video/episode_video.hpp"
