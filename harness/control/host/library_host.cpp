#include "harness/control/host/library_host.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "controller/control/controller_abi.h"
#include "harness/control/controller_protocol.hpp"
#include "harness/control/host/library_problem.hpp"

namespace qsmpc::harness {
namespace {

using nlohmann::json;

constexpr std::size_t kErrorBytes = 1024;
constexpr std::size_t kChunk = 65536;

/// Reads lines from a descriptor.
class LineReader {
 public:
  explicit LineReader(int descriptor) : descriptor_(descriptor) {}

  /// Nothing at the end of the stream.
  [[nodiscard]] std::optional<std::string> next() {
    for (;;) {
      const std::size_t end = buffer_.find('\n', searched_);
      if (end != std::string::npos) {
        std::string line = buffer_.substr(0, end);
        buffer_.erase(0, end + 1);
        searched_ = 0;
        return line;
      }
      searched_ = buffer_.size();
      std::array<char, kChunk> chunk;  // NOLINT(cppcoreguidelines-pro-type-member-init)
      const ssize_t count = ::read(descriptor_, chunk.data(), chunk.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return std::nullopt;
      buffer_.append(chunk.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  int descriptor_;
  std::string buffer_;
  std::size_t searched_ = 0;
};

void write_line(int descriptor, const json& message) {
  const std::string line = message.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t count = ::write(descriptor, line.data() + done, line.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) std::exit(EXIT_FAILURE);  // the program has ended
    done += static_cast<std::size_t>(count);
  }
}

const qsmpc_controller_table& table_of(const std::string& path) {
  void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(::dlerror());
  void* const symbol = ::dlsym(library, "qsmpc_controller");
  if (symbol == nullptr) {
    throw std::runtime_error(path + " does not export the function qsmpc_controller");
  }
  const auto function = reinterpret_cast<const qsmpc_controller_table* (*)()>(symbol);
  const qsmpc_controller_table* const table = function();
  if (table == nullptr) throw std::runtime_error(path + " returns no controller table");
  if (table->abi != QSMPC_CONTROLLER_ABI) {
    throw std::runtime_error(path + " has version " + std::to_string(table->abi) +
                             " of the controller interface; this program has version " +
                             std::to_string(QSMPC_CONTROLLER_ABI));
  }
  if (table->create == nullptr || table->act == nullptr) {
    throw std::runtime_error(path + " has a controller table without create or act");
  }
  return *table;
}

/// The library's controller, and the buffers for its answers.
class LibraryController {
 public:
  LibraryController(const std::string& path, const json& scenario, std::string line)
      : table_(table_of(path)), problem_(scenario, std::move(line)) {
    const qsmpc_problem& problem = problem_.get();
    input_.resize(static_cast<std::size_t>(problem.input_dim));
    if (problem.plans != 0) {
      plan_.resize(input_.size() * static_cast<std::size_t>(problem.horizon));
      gains_.resize(plan_.size() * static_cast<std::size_t>(problem.state_dim));
    }
    std::array<char, kErrorBytes> error{};
    made_ = table_.create(&problem, error.data(), error.size() - 1);
    if (made_ == nullptr) {
      throw std::runtime_error(error[0] == '\0' ? "create returned no controller" : error.data());
    }
  }
  LibraryController(const LibraryController&) = delete;
  LibraryController& operator=(const LibraryController&) = delete;
  ~LibraryController() {
    if (table_.destroy != nullptr) table_.destroy(made_);
  }

  void reset(std::uint64_t seed) {
    if (table_.reset != nullptr) table_.reset(made_, seed);
  }

  [[nodiscard]] json act(const json& message) {
    const std::vector<double> observation = numbers_in(message.at("observation"), 0.0);
    const std::vector<double> mean = numbers_in(message.at("belief").at("mean"), 0.0);
    const std::vector<double> covariance = numbers_in(message.at("belief").at("covariance"), 0.0);
    const qsmpc_situation situation{.period = message.at("period").get<std::int64_t>(),
                                    .periods_left = message.at("periods_left").get<std::int64_t>(),
                                    .time = message.at("time").get<double>(),
                                    .deadline = message.at("deadline").get<double>(),
                                    .observation = observation.data(),
                                    .mean = mean.data(),
                                    .covariance = covariance.data()};
    const bool plans = problem_.get().plans != 0;
    std::fill(gains_.begin(), gains_.end(), 0.0);
    qsmpc_answer answer{.input = input_.data(),
                        .input_count = problem_.get().input_dim,
                        .plan_inputs = plans ? plan_.data() : nullptr,
                        .plan_gains = plans ? gains_.data() : nullptr,
                        .status = nullptr,
                        .evaluations = 0};
    std::array<char, kErrorBytes> error{};
    const std::int32_t code =
        table_.act(made_, &situation, &answer, error.data(), error.size() - 1);
    if (code != 0) {
      return {{"error", error[0] == '\0' ? "act returned " + std::to_string(code) : error.data()}};
    }
    return plans ? plan_json(answer) : input_json(answer);
  }

 private:
  /// Non-finite numbers are sent as strings, so that messages can name them.
  static json number_json(double value) {
    if (std::isfinite(value)) return value;
    return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
  }

  [[nodiscard]] json list_json(const double* values, std::size_t count) const {
    json list = json::array();
    for (std::size_t i = 0; i < count; ++i) list.push_back(number_json(values[i]));
    return list;
  }

  [[nodiscard]] json input_json(const qsmpc_answer& answer) const {
    // A count that exceeds the buffer leaves nothing valid to read.
    const bool fits = answer.input_count >= 0 && answer.input_count <= problem_.get().input_dim;
    if (fits) {
      return {{"input", list_json(input_.data(), static_cast<std::size_t>(answer.input_count))}};
    }
    return {{"error", "an input of " + std::to_string(answer.input_count) + " numbers instead of " +
                          std::to_string(problem_.get().input_dim)}};
  }

  [[nodiscard]] json plan_json(const qsmpc_answer& answer) const {
    const std::size_t inputs = input_.size();
    const auto states = static_cast<std::size_t>(problem_.get().state_dim);
    json stages = json::array();
    json gains = json::array();
    for (std::size_t k = 0; k < static_cast<std::size_t>(problem_.get().horizon); ++k) {
      stages.push_back(list_json(plan_.data() + k * inputs, inputs));
      json gain = json::array();
      for (std::size_t i = 0; i < inputs; ++i) {
        gain.push_back(list_json(gains_.data() + (k * inputs + i) * states, states));
      }
      gains.push_back(std::move(gain));
    }
    json plan{{"inputs", std::move(stages)}, {"gains", std::move(gains)}};
    if (answer.status != nullptr) plan["status"] = answer.status;
    if (answer.evaluations > 0) plan["evaluations"] = answer.evaluations;
    return {{"plan", std::move(plan)}};
  }

  const qsmpc_controller_table& table_;
  LibraryProblem problem_;
  std::vector<double> input_;
  std::vector<double> plan_;
  std::vector<double> gains_;
  void* made_ = nullptr;
};

}  // namespace

int serve_library(const std::string& path, int input, int output) {
  LineReader lines(input);
  std::optional<LibraryController> controller;
  while (std::optional<std::string> line = lines.next()) {
    const json message = json::parse(*line);
    const auto type = message.at("type").get<std::string>();
    if (type == kEndMessage) break;
    try {
      if (type == kScenarioMessage) {
        controller.emplace(path, message, std::move(*line));
        write_line(output, {{"protocol", kProtocolVersion}});
      } else if (type == kResetMessage) {
        controller->reset(message.at("seed").get<std::uint64_t>());
      } else {
        write_line(output, controller->act(message));
      }
    } catch (const std::exception& error) {
      write_line(output, {{"error", error.what()}});
    }
  }
  return EXIT_SUCCESS;
}

}  // namespace qsmpc::harness
