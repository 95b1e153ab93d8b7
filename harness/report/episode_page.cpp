#include "harness/report/episode_page.hpp"

#include <string_view>

#include <fmt/format.h>

#include "harness/report/episode_charts.hpp"
#include "harness/report/episode_map.hpp"
#include "harness/report/html.hpp"
#include "harness/report/key_figures.hpp"
#include "harness/report/page_frame.hpp"
#include "harness/report/svg_chart.hpp"
#include "harness/trace/summary.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {
namespace {

constexpr std::string_view kMeaning =
    "<section class=\"card\">\n<h3>What a certificate says</h3>\n"
    "<p>A certificate is an upper bound of the probability that the <em>model’s</em> state is "
    "unsafe: at the next step, given the belief from which the plan was made. The certificate of a "
    "plan adds its stages up and speaks of the plan as planned, not of what is planned anew at "
    "every step. Neither covers the plant’s mismatch to the model, which is measured "
    "below.</p>\n</section>\n";

constexpr std::string_view kMismatchNote =
    "<h2>Mismatch of the plant against the planner’s model</h2>\n"
    "<p class=\"note\">What is left of the plant’s next state after the model’s prediction and the "
    "disturbance are taken away, over all steps. An exact model has zeros.</p>\n";

std::string introduction(const Trace& trace) {
  const Scenario& scenario = trace.scenario;
  std::string html = fmt::format(
      "<p class=\"kicker\"><strong>{}</strong> · model {} · plant {} · {}, horizon {} · seed "
      "{}</p>\n",
      escape_html(scenario.name), escape_html(scenario.model.system),
      escape_html(scenario.plant.kind),
      scenario.controller.policy == "closed_loop" ? "closed-loop policy" : "open-loop policy",
      scenario.controller.horizon, trace.seed);
  if (!scenario.description.empty()) {
    html += "<p class=\"soft\">" + escape_html(scenario.description) + "</p>\n";
  }
  return html;
}

std::string video(const EpisodePageOptions& options) {
  if (options.video_file.empty()) return {};
  const std::string url = url_beside(options.video_file);
  return fmt::format(
      "<figure class=\"card\">\n<figcaption>Video</figcaption>\n"
      "<video controls muted playsinline preload=\"metadata\" src=\"{}\"></video>\n"
      "<p class=\"note\">The file <a href=\"{}\">{}</a>, beside this page.</p>\n</figure>\n",
      url, url, escape_html(options.video_file));
}

std::string drive(const Trace& trace, const SystemDescription& system,
                  const EpisodePageOptions& options) {
  return fmt::format(
      "<h2>The drive</h2>\n<div class=\"grid\">\n<div class=\"stack\">\n{}{}</div>\n{}</div>\n",
      video(options), kMeaning, episode_map(trace, system));
}

std::string charts(const Trace& trace, const SystemDescription& system) {
  if (trace.steps.empty()) return {};
  std::string html = "<h2>Along the drive</h2>\n<div class=\"grid\">\n";
  for (const Chart& chart : episode_charts(trace, system)) html += chart_figure(chart);
  return html + "</div>\n";
}

std::string ending(const Trace& trace) {
  std::string html =
      "<details>\n<summary>The scenario, with every default filled in</summary>\n<pre>" +
      escape_html(trace.scenario_text) + "</pre>\n</details>\n";
  html += fmt::format("<footer>Made by qsmpc {} from the episode’s trace.</footer>\n",
                      escape_html(trace.version));
  return html + "</body>\n</html>\n";
}

}  // namespace

std::string episode_page(const Trace& trace, const EpisodePageOptions& options) {
  const Scenario& scenario = trace.scenario;
  const auto model =
      make_dynamics(scenario.model.system, scenario.model.parameters, scenario.time_step);
  const SystemDescription& system = model->description();
  const Summary summary = summarise(trace);
  std::string html = page_head(trace.scenario.name + ": episode");
  html += introduction(trace);
  html += outcome_html(trace, summary);
  html += key_figures_html(trace, summary, system);
  html += drive(trace, system, options);
  html += charts(trace, system);
  html += kMismatchNote;
  html += mismatch_html(summary, system);
  html += ending(trace);
  return html;
}

}  // namespace qsmpc
