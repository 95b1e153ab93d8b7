#include "harness/report/episode_page.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "harness/text/number_format.hpp"
#include "harness/trace/episode_view.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace episode_page_test {

using testing::contains;
using testing::example_trace;
using testing::occurrences;
using testing::tag_problem;

EpisodePageOptions with_video() { return {.video_file = "episode.mp4"}; }

/// The page without its own style, scripts and data, whose words do not come from a trace.
std::string markup_of(std::string page) {
  for (const auto& [begin, end] : {std::pair("<style>", "</style>"), {"<script", "</script>"}}) {
    for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at)) {
      const std::size_t last = page.find(end, at);
      if (last == std::string::npos) return "an element has no end: " + std::string(begin);
      page.erase(at, last + std::string(end).size() - at);
    }
  }
  return page;
}

/// The text between `begin` and the next `end`; empty if there is none.
std::string between(const std::string& page, const std::string& begin, const std::string& end) {
  const std::size_t at = page.find(begin);
  if (at == std::string::npos) return {};
  const std::size_t from = at + begin.size();
  return page.substr(from, page.find(end, from) - from);
}

Trace trace_that_failed_at_the_start() {
  Trace trace = testing::example_trace({.steps = 0});
  trace.motion.clear();
  trace.outcome = Outcome::kFault;
  trace.fault = "XML Error: <body> is broken";
  return trace;
}

TEST(EpisodePage, its_tags_are_balanced) {
  EXPECT_EQ(testing::tag_problem(
                markup_of(episode_page(EpisodeView(testing::example_trace()), with_video()))),
            "");
  EXPECT_EQ(testing::tag_problem(
                markup_of(episode_page(EpisodeView(trace_that_failed_at_the_start()), {}))),
            "");
}

TEST(EpisodePage, says_beside_every_certificate_that_it_is_not_a_bound) {
  Trace trace = testing::example_trace();
  EXPECT_FALSE(contains(markup_of(episode_page(EpisodeView(trace), {})), "o bound"));
  const auto states = static_cast<Eigen::Index>(trace.system.states.size());
  trace.scenario.disturbance.sensor = Eigen::MatrixXd::Identity(states, states);
  const std::string whole = episode_page(EpisodeView(trace), {});
  const std::string page = markup_of(whole);
  EXPECT_TRUE(contains(page, "No certificate is a bound here"));
  EXPECT_EQ(occurrences(page, "not a bound: see above"), 3);  // next step, sum, plan
  EXPECT_TRUE(contains(page, "Certificates, not bounds"));
  EXPECT_FALSE(contains(page, "Upper bounds"));
  EXPECT_TRUE(contains(whole, "\"holds\":false"));
  EXPECT_EQ(tag_problem(page), "");
}

TEST(EpisodePage, says_whether_certificates_cover_the_plant) {
  Trace trace = testing::example_trace();
  const std::string of_model = markup_of(episode_page(EpisodeView(trace), {}));
  EXPECT_TRUE(contains(of_model, "that the state of the <em>model</em> is unsafe"));
  EXPECT_TRUE(contains(of_model, "Neither covers the plant’s mismatch"));
  trace.scenario.model_error.emplace();
  const std::string of_plant = markup_of(episode_page(EpisodeView(trace), {}));
  EXPECT_TRUE(contains(of_plant, "any plant within the scenario’s <code>model_error</code>"));
  EXPECT_FALSE(contains(of_plant, "Neither covers"));
}

TEST(EpisodePage, the_tag_check_finds_what_is_wrong) {
  EXPECT_NE(testing::tag_problem("<p><b></p></b>"), "");
  EXPECT_NE(testing::tag_problem("<p>"), "");
  EXPECT_NE(testing::tag_problem("<p>1 < 2</p>"), "");
}

TEST(EpisodePage, refers_to_nothing_but_the_video) {
  const std::string whole = episode_page(EpisodeView(testing::example_trace()), with_video());
  EXPECT_FALSE(testing::contains(whole, "src=\"http"));
  const std::string page = markup_of(whole);
  EXPECT_FALSE(testing::contains(page, "http:"));
  EXPECT_FALSE(testing::contains(page, "https:"));
  EXPECT_FALSE(testing::contains(page, "@import"));
  EXPECT_FALSE(testing::contains(page, "url("));
  EXPECT_FALSE(testing::contains(page, "<link"));
  EXPECT_EQ(testing::occurrences(page, "src="), 1);
  EXPECT_EQ(testing::occurrences(page, "src=\"./episode.mp4\""), 1);
  EXPECT_EQ(testing::occurrences(page, "href="), 1);
  EXPECT_EQ(testing::occurrences(page, "href=\"./episode.mp4\""), 1);
}

TEST(EpisodePage, without_a_video_refers_to_nothing) {
  const std::string page = markup_of(episode_page(EpisodeView(testing::example_trace()), {}));
  EXPECT_EQ(testing::occurrences(page, "src="), 0);
  EXPECT_EQ(testing::occurrences(page, "href="), 0);
  EXPECT_FALSE(testing::contains(page, "<video"));
}

TEST(EpisodePage, its_policy_comes_first_and_forbids_all_but_its_own_and_media) {
  const std::string page = episode_page(EpisodeView(testing::example_trace()), with_video());
  const std::string policy =
      between(page, "<meta http-equiv=\"Content-Security-Policy\" content=\"", "\"");
  EXPECT_TRUE(policy.starts_with("default-src 'none'; style-src 'sha256-")) << policy;
  EXPECT_TRUE(testing::contains(policy, "script-src 'sha256-")) << policy;
  EXPECT_TRUE(
      testing::contains(policy, "media-src 'self' file:; base-uri 'none'; form-action 'none'"));
  EXPECT_FALSE(testing::contains(policy, "unsafe"));
  EXPECT_LT(page.find("Content-Security-Policy"), page.find("<style"));
  EXPECT_LT(page.find("Content-Security-Policy"), page.find("<title"));
}

TEST(EpisodePage, texts_of_the_scenario_do_nothing) {
  const std::string attack = "</title><script>alert(1)</script><img src=x onerror='alert(2)'>";
  Trace trace = testing::example_trace({.name = attack});
  trace.scenario.description = attack;
  trace.scenario.plant.kind = attack;
  trace.version = attack;
  trace.fault = attack;
  trace.steps[1].solver_status = attack;
  const std::string whole =
      episode_page(EpisodeView(trace), {.video_file = "\" onerror=\"alert(3)"});
  // Two scripts: the data, in which no tag can begin or end, and the page's own script.
  EXPECT_EQ(testing::occurrences(whole, "<script"), 2);
  EXPECT_EQ(testing::occurrences(whole, "</script>"), 2);
  const std::string data = between(whole, "id=\"episode-data\">", "</script>");
  EXPECT_TRUE(testing::contains(data, "\\u003c/title\\u003e"));
  EXPECT_EQ(data.find_first_of("<>&"), std::string::npos);
  const std::string page = markup_of(whole);
  EXPECT_FALSE(testing::contains(page, "<script"));
  EXPECT_FALSE(testing::contains(page, "<img"));
  EXPECT_FALSE(testing::contains(page, "onerror='"));
  EXPECT_FALSE(testing::contains(page, "onerror=\""));
  EXPECT_TRUE(testing::contains(page, "&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_EQ(testing::tag_problem(page), "");
}

TEST(EpisodePage, shows_the_numbers_of_the_summary) {
  const Trace trace = testing::example_trace({.steps = 40});
  const Summary summary = EpisodeView(trace).summary();
  const std::string page = episode_page(EpisodeView(trace), with_video());
  const auto value = [](const std::string& text) {
    return "<dd class=\"value\">" + text + "</dd>";
  };
  EXPECT_TRUE(testing::contains(page, "Target reached after 4 s"));
  EXPECT_TRUE(testing::contains(page, value("4 s")));
  EXPECT_TRUE(testing::contains(page, value(format_number(summary.min_clearance) + " m")));
  EXPECT_TRUE(testing::contains(page, value(format_bound(summary.next_step_max))));
  EXPECT_TRUE(testing::contains(page, value(format_bound(summary.next_step_sum))));
  EXPECT_TRUE(testing::contains(page, value(format_bound(summary.horizon_max))));
  EXPECT_TRUE(testing::contains(page, value(format_number(summary.ocp_ms.median) + " / " +
                                            format_number(summary.ocp_ms.p99) + " ms")));
  EXPECT_TRUE(testing::contains(page, value(std::to_string(summary.deadline_misses) + " of 40")));
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_TRUE(
        testing::contains(page, "<td>" + format_number(summary.mismatch_rmse[i]) + "</td>"));
  }
  EXPECT_TRUE(testing::contains(page, "<td>rad</td>"));
}

TEST(EpisodePage, holds_certificates_against_limits_that_are_set) {
  Trace trace = testing::example_trace({.steps = 40});
  EXPECT_FALSE(testing::contains(episode_page(EpisodeView(trace), with_video()), "Plan risk"));
  trace.scenario.risk = {.stage = 1.0, .plan = 0.0};
  const std::string page = episode_page(EpisodeView(trace), with_video());
  EXPECT_TRUE(testing::contains(page, "<dt>Stage risk</dt>"));
  EXPECT_TRUE(testing::contains(page, "limit 1, never exceeded"));
  EXPECT_TRUE(testing::contains(page, "limit 0, exceeded in 40 of 40 periods"));
  EXPECT_FALSE(testing::contains(page, "Mission risk"));
  EXPECT_TRUE(testing::contains(page, "limit of a stage"));
  EXPECT_FALSE(testing::contains(page, "limit of a plan"));  // 0 cannot be shown in the chart
}

TEST(EpisodePage, draws_the_body_along_the_way) {
  Trace trace = testing::example_trace({.steps = 40});
  EXPECT_FALSE(
      testing::contains(episode_page(EpisodeView(trace), with_video()), "body of the vehicle"));
  controller::Body& body = trace.scenario.safe_set.body;
  body.discs = {{.radius = 0.2, .offset = {0.1, 0.0}}};
  ASSERT_EQ(body.heading, 2);
  const std::string page = markup_of(episode_page(EpisodeView(trace), with_video()));
  EXPECT_TRUE(testing::contains(page, "body of the vehicle"));
  // At every tenth of 40 steps and at the end, and once in the legend.
  EXPECT_EQ(testing::occurrences(page, "class=\"outline thin c6\""), 6);
}

TEST(EpisodePage, entering_the_unsafe_set_is_never_shown_as_success) {
  Trace trace = testing::example_trace();
  trace.steps[2].state = Eigen::Vector3d(3.0, 4.0, 0.0);  // inside of the first obstacle
  trace.outcome = Outcome::kCollision;
  const std::string page = episode_page(EpisodeView(trace), with_video());
  EXPECT_TRUE(testing::contains(page, "<section class=\"outcome bad\">"));
  EXPECT_TRUE(testing::contains(page, "✕ Collision after 0.2 s"));
  EXPECT_TRUE(testing::contains(page, "entered the unsafe set: first at 0.2 s."));
  EXPECT_FALSE(testing::contains(page, "✓"));
  EXPECT_FALSE(testing::contains(page, "Target reached"));
  EXPECT_TRUE(testing::contains(page, "Entered the unsafe set</dt><dd class=\"value\">yes</dd>"));
}

TEST(EpisodePage, tells_contacts_and_what_was_between_the_instants_where_they_are_known) {
  Trace trace = testing::example_trace();
  const std::string plain = episode_page(EpisodeView(trace), with_video());
  EXPECT_FALSE(testing::contains(plain, "Unsafe between control instants"));
  EXPECT_FALSE(testing::contains(plain, "Contacts</dt>"));
  for (StepRecord& step : trace.steps) {
    step.clearance_between = 0.5;
    step.contact.force = 0.0;
  }
  trace.steps[1].clearance_between = -0.1;
  trace.steps[1].contact = {.force = 12.0, .time = 0.15};
  const std::string page = episode_page(EpisodeView(trace), with_video());
  EXPECT_TRUE(
      testing::contains(page, "Unsafe between control instants</dt><dd class=\"value\">yes</dd>"));
  EXPECT_TRUE(testing::contains(page, "Contacts</dt><dd class=\"value\">1</dd>"));
  EXPECT_TRUE(testing::contains(page, "the first at 0.15 s, at most 12"));
}

TEST(EpisodePage, says_that_a_drive_went_on_after_its_collision) {
  Trace trace = testing::example_trace();
  trace.steps[2].state = Eigen::Vector3d(3.0, 4.0, 0.0);
  trace.outcome = Outcome::kCollision;
  trace.scenario.stop_when_unsafe = false;
  const std::string page = episode_page(EpisodeView(trace), with_video());
  EXPECT_TRUE(testing::contains(page, "The drive continued (limit"));
  EXPECT_TRUE(testing::contains(page, "and ended after 0.6 s.")) << "not at the target";
  trace.final_state = trace.scenario.target.state;
  EXPECT_TRUE(testing::contains(episode_page(EpisodeView(trace), with_video()),
                                "and ended after 0.6 s at the target."));
}

TEST(EpisodePage, leaving_the_bounds_is_a_failure) {
  Trace trace = testing::example_trace();
  trace.final_state[0] = -1.5;
  trace.outcome = Outcome::kLeftBounds;
  const std::string page = episode_page(EpisodeView(trace), with_video());
  EXPECT_TRUE(testing::contains(page, "<section class=\"outcome bad\">"));
  EXPECT_TRUE(testing::contains(page, "✕ Left the bounds after 0.6 s"));
}

TEST(EpisodePage, says_what_a_certificate_does_not_cover) {
  const std::string page = episode_page(EpisodeView(testing::example_trace()), with_video());
  EXPECT_TRUE(testing::contains(page, "holds for the plan as made"));
  EXPECT_TRUE(testing::contains(page, "Neither covers the plant’s mismatch"));
  EXPECT_TRUE(testing::contains(page, "published method, worst stage: not a bound"));
}

TEST(EpisodePage, has_a_chart_of_each_kind_and_the_map) {
  const std::string page = episode_page(EpisodeView(testing::example_trace()), with_video());
  for (const char* title : {"Certificates: ", "Clearance", "Input: ", "Solve time against",
                            "Solve times: ", "Expected cost", "Error budget at", "Map: "}) {
    EXPECT_EQ(testing::occurrences(page, "<figcaption>" + std::string(title)), 1) << title;
  }
  for (const char* label : {"x (m)", "y (m)", "time (s)", "probability (–)", "wall clock (ms)"}) {
    EXPECT_TRUE(testing::contains(page, ">" + std::string(label) + "</text>"));
  }
}

TEST(EpisodePage, a_fault_at_the_start_shows_its_message_and_no_charts) {
  const std::string page = episode_page(EpisodeView(trace_that_failed_at_the_start()), {});
  EXPECT_TRUE(testing::contains(page, "The simulator failed at the start"));
  EXPECT_TRUE(testing::contains(page, "XML Error: &lt;body&gt; is broken"));
  EXPECT_FALSE(testing::contains(page, "<figcaption>Certificates"));
  EXPECT_TRUE(testing::contains(page, "<figcaption>Map</figcaption>"));
  EXPECT_TRUE(
      testing::contains(page, "Largest next-step certificate</dt><dd class=\"value\">–</dd>"));
}

TEST(EpisodePage, a_trace_without_any_state_gives_a_page) {
  Trace trace = trace_that_failed_at_the_start();
  trace.final_state.resize(0);
  const std::string page = episode_page(EpisodeView(trace), {});
  EXPECT_EQ(testing::tag_problem(markup_of(page)), "");
  EXPECT_TRUE(testing::contains(page, "no known state"));
}

TEST(EpisodePage, numbers_that_are_not_finite_do_not_break_the_drawings) {
  Trace trace = testing::example_trace({.steps = 12});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  trace.steps[3].state.setConstant(nan);
  trace.steps[4].input.setConstant(infinity);
  trace.steps[5].cost[controller::cost_part("state")] = nan;
  trace.steps[6].budgets.back().total = infinity;
  trace.steps[7].certificates.front().value = nan;
  trace.steps[8].certificates.clear();
  trace.steps[8].budgets.clear();
  trace.steps[8].particles.clear();
  trace.steps[9].timing.total = -infinity;
  trace.steps[0].particles.back().locations(0, 0) = nan;
  trace.steps[0].particles.front().weights[1] = nan;
  trace.steps[10].plan_states.setConstant(-infinity);
  trace.final_state.setConstant(1e300);
  const std::string page = episode_page(EpisodeView(trace), with_video());
  const std::string own = markup_of(page);
  EXPECT_EQ(testing::tag_problem(own), "");
  for (std::size_t at = own.find(" d=\""); at != std::string::npos;
       at = own.find(" d=\"", at + 1)) {
    const std::string data = own.substr(at + 4, own.find('"', at + 4) - at - 4);
    EXPECT_EQ(data.find_first_not_of("MLHVhv0123456789.- "), std::string::npos) << data;
  }
  EXPECT_FALSE(testing::contains(own, "=\"nan\""));
  EXPECT_FALSE(testing::contains(own, "=\"inf\""));
  EXPECT_TRUE(testing::contains(own, "not finite and not drawn"));
}

TEST(EpisodePage, a_state_far_away_leaves_the_map_readable) {
  Trace trace = testing::example_trace();
  for (const double sign : {-1.0, 1.0}) {
    trace.final_state[0] = sign * 1e9;
    const std::string page = episode_page(EpisodeView(trace), {});
    const std::size_t begin = page.find("<figcaption>Map");
    const std::string map = page.substr(begin, page.find("</figure>", begin) - begin);
    // The axis extends by one more length of the bounds, -1 … 12, and not to the state.
    EXPECT_TRUE(testing::contains(map, sign > 0.0 ? ">25</text>" : ">−10</text>"));
    EXPECT_FALSE(testing::contains(map, "10⁹"));
    EXPECT_FALSE(testing::contains(map, "10⁸"));
  }
}

TEST(EpisodePage, the_largest_usual_episode_stays_small) {
  constexpr std::size_t kLargest = 5'000'000;  // bytes, without the video
  const Trace trace = testing::example_trace({.steps = 400, .horizon = 18, .points = 100});
  EXPECT_LT(episode_page(EpisodeView(trace), with_video()).size(), kLargest);
}

TEST(EpisodePage, the_same_trace_gives_the_same_page) {
  const Trace trace = testing::example_trace();
  EXPECT_EQ(episode_page(EpisodeView(trace), with_video()),
            episode_page(EpisodeView(trace), with_video()));
}

}  // namespace episode_page_test
}  // namespace qsmpc::harness
