#include "harness/errors.hpp"

#include <utility>

#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

std::string describe(const InputError::Where& where) {
  std::string text = printable(where.file, 400);
  if (where.line > 0) text += ":" + std::to_string(where.line);
  if (!where.key.empty()) text += (text.empty() ? "" : ": ") + printable(where.key);
  std::string detail;
  if (!where.found.empty()) detail = "found " + printable(where.found, 200);
  if (!where.expected.empty()) {
    detail += (detail.empty() ? "expected " : ", expected ") + printable(where.expected, 400);
  }
  if (!detail.empty()) text += (text.empty() ? "" : ": ") + detail;
  return text;
}

}  // namespace

InputError::InputError(Where where)
    : std::runtime_error(describe(where)), where_(std::move(where)) {}

}  // namespace qsmpc::harness
