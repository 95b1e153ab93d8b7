#include "harness/scenario/dynamics_library.hpp"

#include <map>
#include <mutex>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "models/dynamics/own_system.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kKey = "model.library";

[[noreturn]] void refuse(const std::string& found, const std::string& expected) {
  throw InputError({.key = kKey, .found = found, .expected = expected});
}

/// The loader's error message without the path at its beginning.
std::string loader_words(const std::string& path) {
  const char* const words = dlerror();
  std::string text = words == nullptr ? "an unknown error" : words;
  if (text.starts_with(path + ": ")) text.erase(0, path.size() + 2);
  return text;
}

}  // namespace

DynamicsLibrary::DynamicsLibrary(std::string path, void* handle)
    : path_(std::move(path)), handle_(handle), table_(nullptr) {
  const auto function =
      reinterpret_cast<qsmpc_dynamics_function>(dlsym(handle_, QSMPC_DYNAMICS_SYMBOL));
  if (function == nullptr) {
    dlclose(handle_);
    refuse(path_ + " without the symbol " QSMPC_DYNAMICS_SYMBOL,
           "a library that contains QSMPC_REGISTER_DYNAMICS");
  }
  table_ = function();
  const std::uint32_t version = table_ == nullptr ? 0 : table_->version;
  if (version != QSMPC_DYNAMICS_VERSION) {
    dlclose(handle_);
    refuse(fmt::format("{} for version {} of the system table", path_, version),
           fmt::format("version {}: build it with the headers of this program",
                       QSMPC_DYNAMICS_VERSION));
  }
}

DynamicsLibrary::~DynamicsLibrary() { dlclose(handle_); }

std::vector<std::string> DynamicsLibrary::names() const {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < table_->system_count; ++i) {
    names.emplace_back(table_->systems[i]->name);
  }
  return names;
}

const qsmpc_system& DynamicsLibrary::entry(const std::string& name) const {
  for (std::uint32_t i = 0; i < table_->system_count; ++i) {
    if (name == table_->systems[i]->name) return *table_->systems[i];
  }
  const std::vector<std::string> known = names();
  throw InputError({.key = "model.system",
                    .found = name,
                    .expected = known.empty() ? "a library that contains a system"
                                              : expected_names(name, known)});
}

models::EquationSystem DynamicsLibrary::system(const std::string& name) const {
  try {
    return models::own_system_of(entry(name));
  } catch (const models::EquationError& error) {
    refuse(fmt::format("{} ({})", path_, error.what()), "a library whose systems can be used");
  }
}

std::unique_ptr<const models::Dynamics> DynamicsLibrary::make(const models::EquationSystem& system,
                                                              double time_step) const {
  return models::make_own_dynamics(entry(system.name), system, time_step, shared_from_this());
}

std::shared_ptr<const DynamicsLibrary> load_dynamics_library(const std::string& path) {
  // For any other name the loader would search the system's folders.
  if (!path.starts_with('/')) refuse(path, "an absolute path");
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const DynamicsLibrary>> loaded;
  const std::scoped_lock lock(mutex);
  if (auto known = loaded[path].lock()) return known;
  // With lazy binding, an undefined symbol would terminate the program in the middle of a drive.
  void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) refuse(path + " (" + loader_words(path) + ")", "a shared library");
  auto library = std::make_shared<const DynamicsLibrary>(path, handle);
  loaded[path] = library;
  return library;
}

}  // namespace qsmpc::harness
