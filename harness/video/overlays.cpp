#include "harness/video/overlays.hpp"

#include <stdexcept>
#include <string>

#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"

namespace qsmpc::harness {
namespace {

bool* switch_of(Overlays& overlays, std::string_view name) {
  if (name == "particles") return &overlays.particles;
  if (name == "ellipses") return &overlays.ellipses;
  if (name == "tube") return &overlays.tube;
  if (name == "ghost") return &overlays.ghost;
  if (name == "raw") return &overlays.raw;
  if (name == "body") return &overlays.body;
  if (name == "path") return &overlays.path;
  return nullptr;
}

constexpr Overlays kNone{false, false, false, false, false, false, false};

}  // namespace

Overlays overlays_of(const std::vector<std::string>& names) {
  Overlays overlays = kNone;
  for (const std::string& name : names) {
    bool* const wanted = switch_of(overlays, name);
    if (wanted == nullptr) throw std::invalid_argument("overlay \"" + name + "\" does not exist");
    *wanted = true;
  }
  return overlays;
}

Overlays parse_overlays(std::string_view text, std::string_view option) {
  if (text == "none") return kNone;
  if (text == "all") return overlays_of(overlay_names());
  Overlays overlays = kNone;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name(text.substr(begin, end - begin));
    bool* const wanted = switch_of(overlays, name);
    if (wanted == nullptr) {
      throw InputError({.key = std::string(option),
                        .found = name.empty() ? "an empty name" : name,
                        .expected = "all, none, or a comma-separated list of " +
                                    expected_names(name, overlay_names())});
    }
    *wanted = true;
    begin = end + 1;
  }
  return overlays;
}

}  // namespace qsmpc::harness
