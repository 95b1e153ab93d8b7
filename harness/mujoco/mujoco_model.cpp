#include "harness/mujoco/mujoco_model.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <regex>
#include <system_error>
#include <vector>

#include <boost/crc.hpp>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "harness/errors.hpp"
#include "harness/mujoco/mujoco_errors.hpp"
#include "harness/mujoco/newer_mjcf.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kExtendedModel = "qsmpc_extended_model.xml";

std::string expected_model() {
  return fmt::format("a model (MJCF) that MuJoCo {} loads without a warning", mujoco_version());
}

// MuJoCo writes "line 4", "line = 4" or "Line number=4"; its parser reports 0 if the line is
// unknown, in which case the line of an include follows.
int line_in(const std::string& text) {
  static const std::regex pattern("[Ll]ine(?: number)?(?: |=| = )([0-9]{1,8})");
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
    if (const int line = std::stoi((*match)[1].str()); line > 0) return line;
  }
  return 0;
}

SimulatorError model_error(const std::string& path, std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  const std::string hint = newer_mjcf_hint(text);
  return SimulatorError({.file = path,
                         .line = line_in(text),
                         .found = text,
                         .expected = hint.empty() ? expected_model() : hint});
}

struct XmlSource {
  std::string file;
  const mjVFS* files;  // in memory; nullptr: files on disk
};

/// `path`: the file name in errors.
MujocoModelPtr load_xml(const std::string& path, const XmlSource& source) {
  if (!std::ifstream(path).good()) {
    std::error_code ignored;
    const bool is_there = std::filesystem::exists(path, ignored);
    throw InputError({.file = path,
                      .found = is_there ? "a file that cannot be read" : "no such file",
                      .expected = expected_model()});
  }
  // The loader calls srand(), which is not thread-safe.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const MujocoTrap trap;
  std::array<char, 1000> text{};
  MujocoModelPtr model;
  try {
    model.reset(
        mj_loadXML(source.file.c_str(), source.files, text.data(), static_cast<int>(text.size())));
  } catch (const MujocoError& error) {
    throw model_error(path, error.what());
  }
  // The first warning is the cause; the error text may only report a consequence.
  if (model != nullptr && !trap.warnings().empty()) {
    throw model_error(path, trap.warnings().front());
  }
  if (model == nullptr || text.front() != '\0') throw model_error(path, text.data());
  return model;
}

}  // namespace

void MujocoModelDeleter::operator()(mjModel_* model) const { mj_deleteModel(model); }

MujocoModelPtr load_mujoco_model(const std::string& path) {
  return load_xml(path, {.file = path, .files = nullptr});
}

MujocoModelPtr load_mujoco_model_with(const std::string& path, const std::string& more) {
  namespace fs = std::filesystem;
  // In memory, but with the file's own folder, against which MuJoCo resolves the paths in it.
  const std::string file = (fs::path(path).parent_path() / kExtendedModel).string();
  const std::string text = fmt::format("<mujoco>\n<include file=\"{}\"/>\n{}</mujoco>\n",
                                       fs::path(path).filename().string(), more);
  const auto deleter = [](mjVFS* files) {
    mj_deleteVFS(files);
    std::default_delete<mjVFS>{}(files);
  };
  const std::unique_ptr<mjVFS, decltype(deleter)> files(new mjVFS);
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), file.c_str(), static_cast<int>(text.size()));
  std::ranges::copy(text, static_cast<char*>(files->filedata[0]));
  return load_xml(path, {.file = file, .files = files.get()});
}

std::optional<std::string> custom_text(const mjModel_& model, const char* name) {
  const int text = mj_name2id(&model, mjOBJ_TEXT, name);
  if (text < 0) return std::nullopt;
  return std::string(model.text_data + model.text_adr[text]);
}

std::string mujoco_model_digest(const std::string& path) {
  const MujocoModelPtr model = load_mujoco_model(path);
  std::vector<unsigned char> bytes(static_cast<std::size_t>(mj_sizeModel(model.get())));
  mj_saveModel(model.get(), nullptr, bytes.data(), static_cast<int>(bytes.size()));
  // CRC-64 of ECMA-182, in the variant of xz.
  boost::crc_optimal<64, 0x42F0E1EBA9EA3693, ~0ULL, ~0ULL, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return fmt::format("{:016x}", crc.checksum());
}

}  // namespace qsmpc::harness
