// Episodes: driving, reading, writing, drawing, and arrays.
#include "python/src/episodes.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/controllers.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "harness/assembly/chosen_points.hpp"
#include "harness/cli/artefacts.hpp"
#include "harness/episode/episode.hpp"
#include "harness/episode/trace_header.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/plant/plant_check.hpp"
#include "harness/report/episode_page.hpp"
#include "harness/report/figure_files.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/summary.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/trace_writer.hpp"
#include "harness/video/episode_video.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using harness::Scenario;
using harness::StepRecord;
using harness::Trace;

std::vector<std::string> statuses_of(const Episode& episode) {
  std::vector<std::string> statuses;
  for (const StepRecord& step : episode.trace().steps) statuses.push_back(step.solver_status);
  return statuses;
}

/// Writes the files of `qsmpc run` except the video.
void write_files(const Episode& episode, const std::string& folder) {
  harness::write_file(folder + "/" + harness::kScenarioFile, episode.trace().scenario_text);
  harness::discard_artefacts(folder);
  harness::write_summary(episode.view(), folder, /*with_video=*/false);
  harness::write_controller_log(episode.trace(), folder);
  harness::write_page(episode.view(), folder, /*with_video=*/false);
}

void save(const Episode& episode, const std::string& folder) {
  without_lock([&] {
    for (const StepRecord& step : episode.trace().steps) {
      if (!step.certificates.empty()) continue;
      throw std::invalid_argument("an episode driven without certificates has no trace to save");
    }
    harness::make_output_folder(folder);
    harness::write_trace(folder + "/" + harness::kTraceFile, episode.trace());
    write_files(episode, folder);
  });
}

struct RunSettings {
  std::uint64_t seed = 0;
  std::optional<std::uint64_t> plant_seed{};
  std::string out{};
};

Trace drive(const Scenario& asked, const RunSettings& settings,
            const std::optional<harness::ControllerObject>& object,
            const std::function<void(std::size_t, double)>& on_step) {
  const Scenario scenario = harness::with_chosen_points(asked);
  harness::EpisodeOptions options{.seed = settings.seed, .plant_seed = settings.plant_seed};
  if (on_step) {
    options.on_step = [&](const Trace& trace) {
      on_step(trace.steps.size(), trace.steps.back().time);
    };
  }
  std::optional<harness::TraceWriter> writer;
  if (!settings.out.empty()) {
    harness::make_output_folder(settings.out);
    writer.emplace(
        settings.out + "/" + harness::kTraceFile,
        harness::trace_header(object ? harness::with_controller(scenario, *object) : scenario,
                              settings.seed));
    options.writer = &*writer;
  }
  return object ? harness::run_episode(scenario, options, *object)
                : harness::run_episode(scenario, options);
}

std::unique_ptr<Episode> run(const Scenario& scenario, const nb::object& controller,
                             std::uint64_t seed, std::optional<std::uint64_t> plant_seed,
                             const std::string& out, const nb::object& on_step) {
  refuse_beyond_memory(scenario);
  const RunSettings settings{.seed = seed, .plant_seed = plant_seed, .out = out};
  std::optional<harness::ControllerObject> object;
  if (!controller.is_none()) object = controller_object(controller);
  std::function<void(std::size_t, double)> report;
  if (!on_step.is_none()) {
    report = [&](std::size_t done, double time) {
      const nb::gil_scoped_acquire lock;
      on_step(done, time);
    };
  }
  // The files are written before Ctrl-C is raised.
  return without_lock([&] {
    harness::try_plant(scenario);
    auto episode = std::make_unique<Episode>(drive(scenario, settings, object, report));
    if (!out.empty()) write_files(*episode, out);
    return episode;
  });
}

harness::EpisodeVideoOptions video_options(const Episode& episode, const std::string& camera,
                                           std::optional<std::pair<int, int>> size) {
  harness::EpisodeVideoOptions options = harness::video_options(episode.trace().scenario);
  if (!camera.empty()) options.camera = camera;
  if (size) {
    options.width = size->first;
    options.height = size->second;
  }
  return options;
}

void write_video(const Episode& episode, const std::string& path, const std::string& camera,
                 std::optional<std::pair<int, int>> size, std::optional<int> fps, double speed) {
  harness::EpisodeVideoOptions options = video_options(episode, camera, size);
  if (fps) options.fps = *fps;
  options.speed = speed;
  without_lock([&] {
    harness::write_episode_video(episode.view(), options, path,
                                 [](int, int) { return harness::interrupts() == 0; });
  });
}

void write_still(const Episode& episode, const std::string& path, double time,
                 const std::string& camera, std::optional<std::pair<int, int>> size) {
  const harness::EpisodeVideoOptions options = video_options(episode, camera, size);
  without_lock([&] { harness::write_episode_still(episode.view(), options, time, path); });
}

std::vector<std::string> write_figures(const Episode& episode, const std::string& folder) {
  return harness::write_figures(harness::episode_figures(episode.view()), folder);
}

void add_values(nb::class_<Episode>& type) {
  type.def_prop_ro("scenario", [](const Episode& e) { return e.trace().scenario; })
      .def_prop_ro("seed", [](const Episode& e) { return e.trace().seed; })
      .def_prop_ro("version", [](const Episode& e) { return e.trace().version; })
      .def_prop_ro("outcome",
                   [](const Episode& e) { return harness::outcome_name(e.trace().outcome); })
      .def_prop_ro("fault", [](const Episode& e) { return e.trace().fault; })
      .def_prop_ro("controller_log", [](const Episode& e) { return e.trace().controller_log; })
      .def_prop_ro("steps", [](const Episode& e) { return e.trace().steps.size(); })
      .def_prop_ro("stages", [](const Episode& e) { return e.view().parts().stages; })
      .def_prop_ro("has_particles", [](const Episode& e) { return e.view().parts().particles; })
      .def_prop_ro("duration", [](const Episode& e) { return e.view().duration(); })
      .def_prop_ro("statuses", &statuses_of)
      .def("summary_json", [](const Episode& e) { return harness::summary_json(e.view()); })
      .def("page", [](const Episode& e) { return harness::episode_page(e.view(), {}); });
}

}  // namespace

void add_episodes(nb::module_& module) {
  nb::class_<Episode> type(module, "Episode");
  add_values(type);
  add_episode_arrays(type);
  type.def("save", &save, "folder"_a)
      .def("write_video", &write_video, "path"_a, "camera"_a, "size"_a.none(), "fps"_a.none(),
           "speed"_a)
      .def("write_still", &write_still, "path"_a, "time"_a, "camera"_a, "size"_a.none())
      .def("write_figures", &write_figures, "folder"_a);
  module.def("run", &run, "scenario"_a, "controller"_a.none(), "seed"_a, "plant_seed"_a.none(),
             "out"_a, "on_step"_a.none());
  module.def(
      "read_episode",
      [](const std::string& path) {
        return without_lock([&] {
          return std::make_unique<Episode>(std::filesystem::is_directory(path)
                                               ? harness::read_folder(path)
                                               : harness::read_trace(path));
        });
      },
      "path"_a);
}

}  // namespace qsmpc::python
